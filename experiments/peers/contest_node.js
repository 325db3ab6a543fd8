#!/usr/bin/env node
// Libraries of npm as contestants (docs/ask.md has the protocol): three-mesh-bvh, rapier, cannon-es,
// manifold and Jolt. A contestant is a function that imports the library, and returns a card and the
// functions that answer questions.
'use strict';

const fs = require('fs');
const path = require('path');
const readline = require('readline');

const versionOf = (name) =>
  JSON.parse(fs.readFileSync(path.join(__dirname, 'node_modules', name, 'package.json'), 'utf8')).version;

function readObj(file) {
  const vertices = [], triangles = [];
  for (const line of fs.readFileSync(file, 'utf8').split('\n')) {
    const words = line.split(/\s+/);
    if (words[0] === 'v') vertices.push(...words.slice(1, 4).map(Number));
    if (words[0] === 'f') triangles.push(...words.slice(1, 4).map((word) => Number(word) - 1));
  }
  return { vertices, triangles };
}

// ---- three-mesh-bvh ----
// three-mesh-bvh computes in double. By default, a geometry of three.js has vertices in float. Here the
// geometry gets a Float64Array instead.

async function threeMeshBvh() {
  const three = await import('three'), bvh = await import('three-mesh-bvh');

  function triangle(numbers) {
    const out = new bvh.ExtendedTriangle();
    out.a.fromArray(numbers, 0);
    out.b.fromArray(numbers, 3);
    out.c.fromArray(numbers, 6);
    out.needsUpdate = true;
    return out;
  }

  // The tree sorts the triangles in its own order. With `indirect`, the geometry is not changed, and
  // resolveTriangleIndex() returns the number of a triangle in the file.
  function tree(file) {
    const { vertices, triangles } = readObj(file);
    const geometry = new three.BufferGeometry();
    geometry.setAttribute('position', new three.BufferAttribute(new Float64Array(vertices), 3));
    geometry.setIndex(new three.BufferAttribute(new Uint32Array(triangles), 1));
    return new bvh.MeshBVH(geometry, { indirect: true });
  }

  function mesh(self, files) {
    const trees = files.map(tree), identity = new three.Matrix4(), found = [];
    for (let a = 0; a < trees.length; ++a) {
      for (let b = self ? a : a + 1; b < trees.length; ++b) {
        trees[a].bvhcast(trees[b], identity, {
          intersectsTriangles(first, second, atFirst, atSecond) {
            const i = trees[a].resolveTriangleIndex(atFirst), j = trees[b].resolveTriangleIndex(atSecond);
            if (!(a === b && i >= j) && first.intersectsTriangle(second)) found.push([a, i, b, j]);
            return false;
          },
        });
      }
    }
    return found;
  }

  return {
    card: { library: `three-mesh-bvh ${versionOf('three-mesh-bvh')}`, means: 'crossing', degenerate: 'no' },
    mesh,
    pair: (a, b) => triangle(a).intersectsTriangle(triangle(b)),
    distance(a, b) {
      const p = new three.Vector3(), q = new three.Vector3();
      const distance = triangle(a).distanceToTriangle(triangle(b), p, q);
      return [distance, ...p.toArray(), ...q.toArray()];
    },
  };
}

// ---- rapier ----
// rapier computes in float. A query of shapes needs no world.

async function rapier() {
  const { default: RAPIER } = await import('@dimforge/rapier3d-compat');
  await RAPIER.init();
  const at = { x: 0, y: 0, z: 0 }, turned = { x: 0, y: 0, z: 0, w: 1 };
  const point = (n, i) => ({ x: n[i], y: n[i + 1], z: n[i + 2] });
  const triangle = (n) => new RAPIER.Triangle(point(n, 0), point(n, 3), point(n, 6));
  return {
    card: { library: `rapier3d-compat ${versionOf('@dimforge/rapier3d-compat')}`, means: 'crossing', degenerate: 'no' },
    pair: (a, b) => triangle(a).intersectsShape(at, turned, triangle(b), at, turned),
    distance(a, b) {
      const found = triangle(a).contactShape(at, turned, triangle(b), at, turned, 3e38);
      if (!found) throw new Error('contactShape() found no contact within 3e38');
      const of = (p) => [p.x, p.y, p.z];
      return [Math.max(found.distance, 0), ...of(found.point1), ...of(found.point2)];
    },
    inside(file, p) {
      const { vertices, triangles } = readObj(file);
      const mesh = new RAPIER.TriMesh(new Float32Array(vertices), new Uint32Array(triangles), RAPIER.TriMeshFlags.ORIENTED);
      return mesh.containsPoint(at, turned, point(p, 0));
    },
  };
}

// ---- cannon-es ----
// The narrow phase of cannon-es for convex bodies is used. Each triangle is a body of two opposite
// faces. The library's triangle meshes collide only with spheres and planes.

async function cannon() {
  const cannon = await import('cannon-es');
  const at = new cannon.Vec3(), turned = new cannon.Quaternion();
  const body = (n) => new cannon.ConvexPolyhedron({
    vertices: [0, 3, 6].map((i) => new cannon.Vec3(n[i], n[i + 1], n[i + 2])), faces: [[0, 1, 2], [2, 1, 0]] });
  return {
    card: { library: `cannon-es ${versionOf('cannon-es')}`, means: 'crossing', degenerate: 'no' },
    pair: (a, b) => body(a).findSeparatingAxis(body(b), at, turned, at, turned, new cannon.Vec3()),
  };
}

// ---- manifold ----
// manifold tests whether two solids intersect. status() refuses a mesh that is no manifold.

async function manifold() {
  const { default: Module } = await import('manifold-3d');
  const wasm = await Module();
  wasm.setup();
  function solid(file) {
    const { vertices, triangles } = readObj(file);
    const out = wasm.Manifold.ofMesh(new wasm.Mesh({
      numProp: 3, vertProperties: new Float32Array(vertices), triVerts: new Uint32Array(triangles) }));
    if (out.status() !== 'NoError') throw new Error(`Manifold.status(): ${out.status()}`);
    return out;
  }
  return {
    card: { library: `manifold-3d ${versionOf('manifold-3d')}` },
    clash: (first, second) => !solid(first).intersect(solid(second)).isEmpty(),
  };
}

// ---- Jolt ----
// The JavaScript version has no shape of one triangle, and no function that tests two meshes.

async function jolt() {
  const { default: init } = await import('jolt-physics');
  const Jolt = await init(), filter = new Jolt.ShapeFilter(), known = {};
  const placed = new Jolt.TransformedShape();
  placed.mShapePositionCOM = new Jolt.RVec3(0, 0, 0);
  placed.mShapeRotation = Jolt.Quat.prototype.sIdentity();
  function shape(file) {
    const { vertices, triangles } = readObj(file), points = new Jolt.VertexList(), faces = new Jolt.IndexedTriangleList();
    for (let i = 0; i < vertices.length; i += 3) points.push_back(new Jolt.Float3(...vertices.slice(i, i + 3)));
    for (let i = 0; i < triangles.length; i += 3) faces.push_back(new Jolt.IndexedTriangle(...triangles.slice(i, i + 3), 0));
    const made = new Jolt.MeshShapeSettings(points, faces, new Jolt.PhysicsMaterialList()).Create();
    if (made.HasError()) throw new Error(made.GetError().c_str());
    return made.Get();
  }
  return {
    card: { library: `jolt-physics ${versionOf('jolt-physics')}` },
    inside(file, p) {
      placed.mShape = known[file] ??= shape(file);
      const found = new Jolt.CollidePointAnyHitCollisionCollector(), point = new Jolt.RVec3(...p);
      placed.CollidePoint(point, found, filter);
      const inside = found.HadHit();
      Jolt.destroy(found);
      Jolt.destroy(point);
      return inside;
    },
  };
}

// ---- the protocol ----

const kContestants = { 'three-mesh-bvh': threeMeshBvh, rapier3d: rapier, 'cannon-es': cannon, 'manifold-3d': manifold,
  'jolt-physics': jolt };

// Returns the lines of an answer, without the number of the question.
function answer(question, fields, contestant) {
  if (question === 'card') {
    const answers = ['pair', 'mesh', 'distance', 'inside', 'clash'].filter((word) => word in contestant);
    const card = { answers: answers.join(' '), ...contestant.card };
    return [...Object.entries(card).map(([key, value]) => `card\t${key}\t${value}`), 'done'];
  }
  const ask = contestant[question];
  if (!ask) return ['refused\tit does not answer this kind of question'];
  const numbers = fields.slice(-18).map(Number);
  const since = process.hrtime.bigint();
  const found = {
    pair: () => ask(numbers.slice(0, 9), numbers.slice(9)), distance: () => ask(numbers.slice(0, 9), numbers.slice(9)),
    mesh: () => ask(fields[0] === '1', fields.slice(1)), inside: () => ask(fields[0], fields.slice(1).map(Number)),
    clash: () => ask(fields[0], fields[1]),
  }[question]();
  const ns = process.hrtime.bigint() - since;
  if (question === 'mesh') return [...found.map((pair) => `pair\t${pair.join('\t')}`), `done\t${ns}`];
  return [question === 'distance' ? found.join('\t') : `${found ? 1 : 0}\t${ns}`];
}

async function main() {
  const name = process.argv[2];
  if (process.argv.length !== 3 || !kContestants[name]) {
    process.stderr.write(`usage: NAME, one of ${Object.keys(kContestants).join(' ')}\n`);
    process.exit(2);
  }
  console.log = console.warn = () => {};  // the library's own output is no answer
  let contestant;
  try {
    contestant = await kContestants[name]();
  } catch (error) {
    process.stderr.write(`${name} is not installed in ${__dirname} by npm\n`);
    process.exit(2);
  }
  contestant.card = { name, ...contestant.card };
  for await (const line of readline.createInterface({ input: process.stdin })) {
    const [number, question, ...fields] = line.split('\t');
    let lines;
    try {
      lines = answer(question, fields, contestant);
    } catch (error) {
      lines = [`refused\t${String(error).replace(/\s+/g, ' ')}`];
    }
    fs.writeSync(1, lines.map((text) => `${number}\t${text}\n`).join(''));
  }
}

main();
