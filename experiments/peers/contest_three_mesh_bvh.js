#!/usr/bin/env -S node --max-old-space-size=2048
// three-mesh-bvh as a contestant (experiments/peers/contestant.h has the protocol): its test
// of two triangles, and its trees searched against each other by bvhcast(). It computes in double.
// A geometry of three.js holds the vertices of a mesh in float by default, but also takes a
// Float64Array, which is used here.
'use strict';

const fs = require('fs');
const path = require('path');
const readline = require('readline');

const card = (version) => `name three-mesh-bvh
library three-mesh-bvh ${version}
means crossing
degenerate no
neighbours no
promises no
pairs yes
meshes yes
memory 65536
call ExtendedTriangle.intersectsTriangle(); meshes by MeshBVH.bvhcast() with intersectsTriangles; not centred, which would round
says nothing of exactness or of touching: "Returns whether the triangles intersect"; of geometry far from the origin "it is recommended that geometry be centered"
source README, Gotchas; the comments of ExtendedTriangle.intersectsTriangle() and MeshBVH.bvhcast()
use to "speed up raycasting and enable spatial queries against three.js meshes", near the origin

`;

function triangle(three, bvh, numbers) {
  const out = new bvh.ExtendedTriangle();
  out.a.fromArray(numbers, 0);
  out.b.fromArray(numbers, 3);
  out.c.fromArray(numbers, 6);
  out.needsUpdate = true;
  return out;
}

function readObj(file, three) {
  const positions = [], indices = [];
  for (const line of fs.readFileSync(file, 'utf8').split('\n')) {
    const words = line.split(/\s+/);
    if (words[0] === 'v') positions.push(...words.slice(1, 4).map(Number));
    if (words[0] === 'f') indices.push(...words.slice(1, 4).map((word) => Number(word) - 1));
  }
  const geometry = new three.BufferGeometry();
  geometry.setAttribute('position', new three.BufferAttribute(new Float64Array(positions), 3));
  geometry.setIndex(new three.BufferAttribute(new Uint32Array(indices), 1));
  return geometry;
}

function askPair(fields, { three, bvh }) {
  const numbers = fields.slice(2).map(Number);
  const a = triangle(three, bvh, numbers.slice(0, 9)), b = triangle(three, bvh, numbers.slice(9));
  const since = process.hrtime.bigint();
  const meets = a.intersectsTriangle(b);
  const ns = process.hrtime.bigint() - since;
  return `${fields[0]}\t${meets ? 1 : 0}\t${ns}\n`;
}

function askMesh(fields, { three, bvh }) {
  const self = fields[1] === '1';
  const geometries = fields.slice(2).map((file) => readObj(file, three));
  const since = process.hrtime.bigint();
  // The tree reorders triangles. With `indirect` it leaves the geometry as it is, and says which
  // triangle is at each place of its order.
  const trees = geometries.map((geometry) => new bvh.MeshBVH(geometry, { indirect: true }));
  const identity = new three.Matrix4();
  let out = '';
  for (let a = 0; a < trees.length; ++a) {
    for (let b = self ? a : a + 1; b < trees.length; ++b) {
      trees[a].bvhcast(trees[b], identity, {
        intersectsTriangles(first, second, atFirst, atSecond) {
          const i = trees[a].resolveTriangleIndex(atFirst), j = trees[b].resolveTriangleIndex(atSecond);
          if (a === b && i >= j) return false;
          if (first.intersectsTriangle(second)) out += `${fields[0]}\tpair\t${a}\t${i}\t${b}\t${j}\n`;
          return false;
        },
      });
    }
  }
  const ns = process.hrtime.bigint() - since;
  return `${out}${fields[0]}\tdone\t${ns}\n`;
}

async function main() {
  const [name, what] = process.argv.slice(2);
  let libraries;
  try {
    libraries = { three: await import('three'), bvh: await import('three-mesh-bvh') };
  } catch (error) {
    process.stderr.write(`three and three-mesh-bvh are not installed in ${__dirname} by npm\n`);
    process.exit(2);
  }
  if (name === 'list') {
    const file = path.join(__dirname, 'node_modules', 'three-mesh-bvh', 'package.json');
    process.stdout.write(card(JSON.parse(fs.readFileSync(file, 'utf8')).version));
    return;
  }
  const ask = { pairs: askPair, meshes: askMesh }[what];
  if (name !== 'three-mesh-bvh' || !ask) {
    process.stderr.write('usage: list | three-mesh-bvh pairs | three-mesh-bvh meshes\n');
    process.exit(2);
  }
  for await (const line of readline.createInterface({ input: process.stdin })) {
    const fields = line.split('\t');
    let answer;
    try {
      answer = ask(fields, libraries);
    } catch (error) {
      answer = `${fields[0]}\trefused\t${String(error).replace(/\s+/g, ' ')}\n`;
    }
    fs.writeSync(1, answer);
  }
}

main();
