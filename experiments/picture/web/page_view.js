// Unpacks the scene of a page, and draws it with three.js and WebGL 2. Triangles share no vertices, so
// gl_VertexID / 3 is the number of a triangle. The texture `states` has a byte of flags for each triangle. The
// texture `places` has, for each object, its shift in an exploded view. The unit of length is half the largest
// extent of the scene's box. The origin is the middle of the box.

const byId = (id) => document.getElementById(id);
const about = JSON.parse(byId("data").textContent);
const digits = new Intl.NumberFormat("en");

function element(tag, text, properties) {
  const out = Object.assign(document.createElement(tag), properties);
  if (text !== undefined) out.textContent = text;
  return out;
}

function css(colour) { return `rgb(${colour.join(", ")})`; }

// Returns a line of the legend: a box of this colour, and the text.
function legendLine(colour, text) {
  const line = element("li"), box = element("i");
  box.style.background = colour;
  line.append(box, text);
  return line;
}

// Adds event listeners to the controls. Each row: the id of a control, the event, and the action.
function connect(rows) {
  const all = [...rows, ["licence-button", "click", () => byId("licence").showModal()],
    ["controls", "submit", (e) => e.preventDefault()]];
  for (const [id, event, act] of all) byId(id).addEventListener(event, act);
  byId("licence-text").textContent = byId("three-licence").textContent.trim();
}

const REST = 0, IDLE = 1, COLLIDES = 2, MISSED = 4, CHOSEN = 8, PARTNER = 16;
const STATE_WIDTH = 2048, OBJECT_WIDTH = 256;

const VERTEX_SHADER = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform sampler2D states, places;
uniform vec3 ratio;
uniform vec3 palette[8];
uniform vec3 found, missed, idle, chosen, partner;
uniform float idlePart, explode, lift, pointSize, through;
uniform int part;  // draws 0: all triangles, 1: colliding ones over the rest, 2: missed, 3: chosen
in vec4 position;  // xyz: 0 to 1 in the scene's box; w: number of the object / 65535
out vec3 placed, seen;
flat out vec4 paint;
flat out int shaded;
flat out int number;
flat out int ghost;  // 1: only every fourth pixel is drawn, so the triangle is see-through
void main() {
  int object = int(position.w * 65535.0 + 0.5);
  number = gl_VertexID / 3;
  int state = int(texelFetch(states, ivec2(number % 2048, number / 2048), 0).r * 255.0 + 0.5);
  vec4 place = texelFetch(places, ivec2(object % 256, object / 256), 0);
  placed = position.xyz;
  vec4 at = modelViewMatrix * vec4((2.0 * position.xyz - 1.0) * ratio + explode * place.xyz, 1.0);
  seen = at.xyz;
  if (part == 0 && (state & 2) != 0) at.z += lift;
  gl_Position = place.w > 0.5 ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * at;
  gl_PointSize = pointSize;
  ghost = place.w > 0.1 ? 1 : 0;
  vec3 plain = ghost == 1 ? vec3(0.6) : palette[object % 8];
  vec3 colour = (state & 2) != 0 ? found : (state & 1) != 0 ? mix(plain, idle, idlePart) : plain;
  if (part == 2) colour = missed;
  if (part == 3) colour = (state & 8) != 0 ? chosen : partner;
  paint = vec4(colour, part == 1 ? through : 1.0);
  shaded = part == 0 ? 1 : 0;
}`;

const FRAGMENT_SHADER = `#version 300 es
precision highp float;
precision highp int;
uniform vec4 cut;  // clipping plane: fragments with dot(cut.xyz, placed) > cut.w are discarded
uniform int picking;
in vec3 placed, seen;
flat in vec4 paint;
flat in int shaded;
flat in int number;
flat in int ghost;
out vec4 colour;
// The light comes over the viewer's left shoulder, as in the flat picture.
const vec3 kLight = vec3(-0.45, 0.60, 0.66);
void main() {
  if (dot(cut.xyz, placed) > cut.w) discard;
  if (ghost == 1 && (picking != 0 || ((int(gl_FragCoord.x) & 1) | (int(gl_FragCoord.y) & 1)) != 0)) discard;
  if (picking != 0) {
    int id = number + 1;
    colour = vec4(float(id & 255), float(id >> 8 & 255), float(id >> 16 & 255), 255.0) / 255.0;
    return;
  }
  vec3 normal = cross(dFdx(seen), dFdy(seen));
  float size = length(normal);
  float light = 1.0;
  if (shaded != 0 && size > 0.0)
    light = 0.42 + 0.66 * abs(dot(normal, normalize(kLight))) / size;
  colour = vec4(min(paint.rgb * light, 1.0), paint.a);
}`;

function shareOf(colour) {
  return new THREE.Vector3(colour[0] / 255, colour[1] / 255, colour[2] / 255);
}

class SceneView {
  constructor(canvas, about) {
    const context = canvas.getContext("webgl2", { antialias: true, stencil: true, alpha: false });
    if (!context) throw new Error("This browser has no WebGL 2 here.");
    this.canvas = canvas;
    this.about = about;
    this.renderer = new THREE.WebGLRenderer({ canvas, context, antialias: true, stencil: true, alpha: false });
    this.scene = new THREE.Scene();
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.01, 60);
    this.camera.up.fromArray(about.worldUp);
    const colours = about.colours;
    this.uniforms = {
      states: { value: null }, places: { value: null },
      ratio: { value: new THREE.Vector3().fromArray(about.ratio) },
      palette: { value: colours.objects.map(shareOf) },
      found: { value: shareOf(colours.found) }, missed: { value: shareOf(colours.missed) },
      idle: { value: shareOf(colours.idle) }, idlePart: { value: colours.idlePart },
      chosen: { value: shareOf([31, 95, 255]) }, partner: { value: shareOf([140, 80, 255]) },
      explode: { value: 0 }, lift: { value: 0 }, pointSize: { value: 3 },
      through: { value: colours.through },
      cut: { value: new THREE.Vector4(0, 0, 0, 1) }, picking: { value: 0 }
    };
    this.materials = [0, 1, 2, 3].map((part) => this.material(part));
    this.target = new THREE.WebGLRenderTarget(1, 1,
      { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter, generateMipmaps: false });
    this.drawn = [];
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    this.controls.rotateSpeed = 0.8;
    this.controls.addEventListener("change", () => this.ask());
    this.asked = false;
    this.onDraw = () => {};
    this.paper = new THREE.Color(0xffffff);
  }

  material(part) {
    const uniforms = Object.assign({}, this.uniforms, { part: { value: part } });
    const over = part > 0;
    const material = new THREE.RawShaderMaterial({
      vertexShader: VERTEX_SHADER, fragmentShader: FRAGMENT_SHADER, uniforms,
      side: THREE.DoubleSide, transparent: over, depthTest: !over, depthWrite: !over
    });
    if (part === 1) {
      // Draws each pixel once, even where several triangles overlap in the picture.
      material.stencilWrite = true;
      material.stencilFunc = THREE.EqualStencilFunc;
      material.stencilRef = 0;
      material.stencilZPass = THREE.IncrementStencilOp;
    }
    return material;
  }

  // corners: three vertex numbers for each triangle; positions: all x, all y, all z, 0 to 65535; owner: the
  // object of each triangle; objects: [name, first triangle, number of triangles].
  setFrame({ corners, positions, owner, objects }) {
    const triangles = owner.length, vertices = positions.length / 3;
    const array = new Uint16Array(12 * triangles);
    const box = objects.map(() => new THREE.Box3());
    const at = new THREE.Vector3(), ratio = this.uniforms.ratio.value;
    for (let i = 0; i < 3 * triangles; ++i) {
      const v = corners[i], o = owner[(i / 3) | 0];
      array[4 * i] = positions[v];
      array[4 * i + 1] = positions[vertices + v];
      array[4 * i + 2] = positions[2 * vertices + v];
      array[4 * i + 3] = o;
      at.set(array[4 * i], array[4 * i + 1], array[4 * i + 2]);
      box[o].expandByPoint(at);
    }
    for (const b of box) {
      for (const p of [b.min, b.max]) p.multiplyScalar(2 / 65535).subScalar(1).multiply(ratio);
    }
    this.boxes = box;
    this.points = new THREE.BufferAttribute(array, 4, true);
    const rows = Math.max(1, Math.ceil(triangles / STATE_WIDTH));
    this.states = new THREE.DataTexture(new Uint8Array(rows * STATE_WIDTH), STATE_WIDTH, rows,
      THREE.RedFormat, THREE.UnsignedByteType);
    this.states.unpackAlignment = 1;
    this.uniforms.states.value = this.states;
    this.triangles = triangles;
    this.setPlaces(objects);
    this.setIndices();
  }

  // Sets the shifts of the objects in an exploded view. Objects move away from the middle of the scene. Objects
  // at the middle move in different directions.
  setPlaces(objects) {
    const rows = Math.max(1, Math.ceil(objects.length / OBJECT_WIDTH));
    const data = new Float32Array(4 * rows * OBJECT_WIDTH);
    const middle = new THREE.Vector3();
    for (let o = 0; o < objects.length; ++o) {
      if (!this.boxes[o].isEmpty()) this.boxes[o].getCenter(middle);
      if (middle.length() < 0.05 && objects.length > 1) {
        const turn = 2.399963 * o, height = 1 - (2 * o + 1) / objects.length;
        const radius = 0.7 * Math.sqrt(1 - height * height);
        middle.set(radius * Math.cos(turn), 0.7 * height, radius * Math.sin(turn));
      }
      middle.multiplyScalar(1.6).toArray(data, 4 * o);
      middle.set(0, 0, 0);
    }
    this.places = new THREE.DataTexture(data, OBJECT_WIDTH, rows, THREE.RGBAFormat, THREE.FloatType);
    this.uniforms.places.value = this.places;
    this.places.needsUpdate = true;
  }

  hide(object, hidden) {
    this.places.image.data[4 * object + 3] = hidden ? 1 : 0;
    this.places.needsUpdate = true;
    this.ask();
  }

  // Makes an object a ghost: it is drawn see-through, and cannot be picked.
  ghost(object, ghost, hidden) {
    this.places.image.data[4 * object + 3] = hidden ? 1 : ghost ? 0.25 : 0;
    this.places.needsUpdate = true;
  }

  setStates(states) {
    this.states.image.data.set(states);
    this.states.needsUpdate = true;
    this.setIndices();
    this.ask();
  }

  geometry(index) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.points);
    if (index) geometry.setIndex(new THREE.BufferAttribute(index, 1));
    return geometry;
  }

  // Returns vertex indices for all triangles whose state has one of `bits`. kind: draws "faces", "edges" or
  // "points" (the first corner of each triangle).
  indexOf(bits, kind) {
    const data = this.states.image.data, out = [];
    for (let t = 0; t < this.triangles; ++t) {
      if ((data[t] & bits) === 0) continue;
      const c = 3 * t;
      if (kind === "faces") out.push(c, c + 1, c + 2);
      if (kind === "edges") out.push(c, c + 1, c + 1, c + 2, c + 2, c);
      if (kind === "points") out.push(c);
    }
    return new Uint32Array(out);
  }

  setIndices() {
    for (const object of this.drawn) {
      this.scene.remove(object);
      object.geometry.dispose();
    }
    this.drawn = [];
    const add = (object, order) => {
      object.frustumCulled = false;
      object.renderOrder = order;
      this.drawn.push(object);
      this.scene.add(object);
    };
    const some = (bits, part, kinds, order) => {
      const faces = this.indexOf(bits, "faces");
      if (faces.length === 0) return;
      const make = { faces: THREE.Mesh, edges: THREE.LineSegments, points: THREE.Points };
      for (const kind of kinds) {
        const index = kind === "faces" ? faces : this.indexOf(bits, kind);
        add(new make[kind](this.geometry(index), this.materials[part]), order++);
      }
    };
    add(new THREE.Mesh(this.geometry(null), this.materials[0]), 0);
    some(COLLIDES, 1, ["faces"], 1);
    // Edges and a point make a missed triangle visible, however small it is.
    some(MISSED, 2, ["faces", "edges", "points"], 2);
    some(PARTNER, 3, ["faces", "edges"], 5);
    some(CHOSEN, 3, ["faces", "edges", "points"], 7);
  }

  // Looks along the direction -towards, and zooms so that all points fit into the view.
  fit(points, towards) {
    this.controls.target.set(0, 0, 0);
    this.camera.position.copy(towards).multiplyScalar(30);
    this.camera.lookAt(0, 0, 0);
    this.camera.updateMatrixWorld();
    const inverse = new THREE.Matrix4().getInverse(this.camera.matrixWorld);
    const box = new THREE.Box3();
    for (const p of points) box.expandByPoint(p.clone().applyMatrix4(inverse));
    const middle = box.getCenter(new THREE.Vector3()), size = box.getSize(new THREE.Vector3());
    const move = this.axis(0).multiplyScalar(middle.x).add(this.axis(1).multiplyScalar(middle.y));
    this.controls.target.copy(move);
    this.camera.position.add(move);
    const [width, height] = this.size();
    const aspect = width / height;
    this.camera.zoom = 0.92 * Math.min(2 * aspect / Math.max(size.x, 1e-6), 2 / Math.max(size.y, 1e-6));
    this.resize();
    this.controls.update();
    this.ask();
  }

  cornersOfBoxes() {
    const out = [];
    for (const box of this.boxes) {
      if (box.isEmpty()) continue;
      for (let i = 0; i < 8; ++i) {
        out.push(new THREE.Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
          i & 4 ? box.max.z : box.min.z));
      }
    }
    return out;
  }

  // Returns the displayed position of a triangle's corner k (0 to 2).
  corner(triangle, k) {
    const a = this.points.array, i = 4 * (3 * triangle + k), ratio = this.uniforms.ratio.value;
    const p = new THREE.Vector3(a[i], a[i + 1], a[i + 2]).multiplyScalar(2 / 65535).subScalar(1).multiply(ratio);
    const place = new THREE.Vector3().fromArray(this.places.image.data, 4 * a[i + 3]);
    return p.add(place.multiplyScalar(this.uniforms.explode.value));
  }

  middle(triangle) {
    const p = this.corner(triangle, 0).add(this.corner(triangle, 1)).add(this.corner(triangle, 2));
    return p.multiplyScalar(1 / 3);
  }

  // Returns the place of the triangle's middle on the canvas, in CSS px.
  project(triangle) {
    const p = this.middle(triangle).project(this.camera);
    const [width, height] = this.size();
    return [0.5 * (1 + p.x) * width, 0.5 * (1 - p.y) * height];
  }

  // Moves the view, without turning it, so that the triangle is in the middle.
  centre(triangle) {
    this.shift(this.middle(triangle).sub(this.controls.target));
  }

  size() {
    return [Math.max(1, this.canvas.clientWidth), Math.max(1, this.canvas.clientHeight)];
  }

  resize() {
    const [width, height] = this.size();
    const aspect = width / height;
    this.renderer.setPixelRatio(window.devicePixelRatio || 1);
    this.renderer.setSize(width, height, false);
    this.camera.left = -aspect;
    this.camera.right = aspect;
    this.camera.updateProjectionMatrix();
    this.uniforms.pointSize.value = 3 * (window.devicePixelRatio || 1);
    this.ask();
  }

  // Turns the camera around the middle of the view, by angles in radians.
  turn(sideways, upwards) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const up = this.camera.up;
    offset.applyAxisAngle(up, -sideways);
    const right = new THREE.Vector3().crossVectors(up, offset).normalize();
    const angle = offset.angleTo(up), next = Math.min(Math.PI - 0.01, Math.max(0.01, angle - upwards));
    offset.applyAxisAngle(right, next - angle);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.ask();
  }

  move(right, up) {
    const by = this.axis(0).multiplyScalar(2 * right / this.camera.zoom);
    this.shift(by.add(this.axis(1).multiplyScalar(2 * up / this.camera.zoom)));
  }

  // Returns the direction to the right (k = 0) or upwards (k = 1) in the picture.
  axis(k) { return new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, k); }

  shift(by) {
    this.controls.target.add(by);
    this.camera.position.add(by);
    this.controls.update();
    this.ask();
  }

  zoom(factor) {
    this.camera.zoom *= factor;
    this.camera.updateProjectionMatrix();
    this.ask();
  }

  // Schedules a draw before the next refresh of the screen. Several calls cause only one draw.
  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.asked = false;
    // Colliding triangles may coincide with others, and would flicker. So they are drawn 2 px nearer to the eye.
    this.uniforms.lift.value = 4 / (this.size()[1] * this.camera.zoom);
    this.renderer.setClearColor(this.paper, 1);
    this.renderer.render(this.scene, this.camera);
    this.onDraw();
  }

  // Returns the visible triangle at (x, y) of the canvas, in CSS px; -1 if there is no triangle.
  pick(x, y) {
    const [width, height] = this.size();
    this.camera.setViewOffset(width, height, Math.floor(x), Math.floor(y), 1, 1);
    this.uniforms.picking.value = 1;
    this.materials[1].visible = this.materials[3].visible = false;
    this.renderer.setRenderTarget(this.target);
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.clear();
    this.renderer.render(this.scene, this.camera);
    const pixel = new Uint8Array(4);
    this.renderer.readRenderTargetPixels(this.target, 0, 0, 1, 1, pixel);
    this.renderer.setRenderTarget(null);
    this.materials[1].visible = this.materials[3].visible = true;
    this.uniforms.picking.value = 0;
    this.camera.clearViewOffset();
    return (pixel[0] | pixel[1] << 8 | pixel[2] << 16) - 1;
  }
}

// ---- the camera and the pointer ----------------------------------------------------------------

// cameraText() returns the state of the camera; `fitted` is the state after resetView(). When the window is
// resized, the view is reset if the reader has not moved the camera.
const cameraText = () => JSON.stringify([view.camera.position, view.controls.target, view.camera.zoom]);
let fitted = "";

function resetView() {
  const points = about.zoom ? collidingCorners() : view.cornersOfBoxes();
  view.fit(points.length > 0 ? points : view.cornersOfBoxes(), new THREE.Vector3().fromArray(about.forward).negate());
  fitted = cameraText();
}

const VIEW_KEYS = {
  ArrowLeft: (shift) => (shift ? view.move(-0.05, 0) : view.turn(-0.1, 0)),
  ArrowRight: (shift) => (shift ? view.move(0.05, 0) : view.turn(0.1, 0)),
  ArrowUp: (shift) => (shift ? view.move(0, 0.05) : view.turn(0, 0.1)),
  ArrowDown: (shift) => (shift ? view.move(0, -0.05) : view.turn(0, -0.1)),
  "+": () => view.zoom(1.2), "=": () => view.zoom(1.2), "-": () => view.zoom(1 / 1.2), 0: resetView
};

function onResize() {
  if (!view) return;
  if (cameraText() === fitted) resetView(); else view.resize();
}

function collidingCorners() {
  const out = [];
  for (let p = 0; p < frame.a.length; ++p)
    for (const t of [frame.a[p], frame.b[p]]) for (const k of [0, 1, 2]) out.push(view.corner(t, k));
  return out;
}

// Shows the scene. Pressing and releasing the button at one place chooses a triangle. Drags move the camera.
function connectCanvas() {
  const canvas = byId("canvas");
  let down = null;
  canvas.addEventListener("pointerdown", (e) => { down = e.button === 0 ? [e.clientX, e.clientY] : null; });
  window.addEventListener("pointerup", (e) => {
    const at = down;
    down = null;
    if (!at || e.target !== canvas || Math.hypot(e.clientX - at[0], e.clientY - at[1]) > 4) return;
    const place = canvas.getBoundingClientRect();
    choose(view.pick(e.clientX - place.left, e.clientY - place.top));
    canvas.focus();
  });
  canvas.addEventListener("webglcontextlost", (e) => {
    e.preventDefault();
    standIn("The browser took the graphics away. Load the page again to look around.");
  });
  new ResizeObserver(onResize).observe(byId("stage"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", showPaper);
  showPaper();
  resetView();
  view.onDraw = markReady;
}

// Stores the time of the first draw in the page, for tests.
function markReady() {
  if (view) view.onDraw = () => {};
  document.documentElement.dataset.ready = String(Math.round(performance.now()));
}

// Gives the scene the background of the page, light or dark.
function showPaper() {
  if (!view) return;
  view.paper = new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue("--paper").trim());
  view.ask();
}

// ---- data ---------------------------------------------------------------------------------------

// Returns the bytes of a block of the page. The block is Base64 of gzip of the bytes.
async function bytesOf(name) {
  const text = atob(byId(name).textContent);
  const small = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) small[i] = text.charCodeAt(i);
  const stream = new Blob([small]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Returns the numbers of a block that packed_numbers() wrote (experiments/picture/picture.h).
async function numbersOf(name) {
  const bytes = await bytesOf(name), n = bytes.length / 4;
  const out = new Uint32Array(n);
  let before = 0;
  for (let i = 0; i < n; ++i) {
    const zigzag = (bytes[i] | bytes[n + i] << 8 | bytes[2 * n + i] << 16 | bytes[3 * n + i] << 24) >>> 0;
    before = (before + ((zigzag >>> 1) ^ -(zigzag & 1))) >>> 0;
    out[i] = before;
  }
  return out;
}

let frame = null;  // all data of the scene

async function loadFrame() {
  const { objects, triangles, ...entry } = about.frame;
  const [positions, a, b, contacts, corners] = await Promise.all([
    numbersOf(entry.positions), numbersOf(entry.a), numbersOf(entry.b), bytesOf(entry.contacts),
    numbersOf(entry.corners)]);
  const owner = new Uint32Array(triangles);
  objects.forEach(([, first, count], o) => owner.fill(o, first, first + count));
  return { positions, a, b, contacts, corners, objects, triangles, owner };
}

// Returns the step's result: a byte for each pair (1: missed), and a bit for each triangle (1: kept, but in no
// collision).
async function loadStep(step) {
  const lost = step.missed ? await numbersOf(step.missed) : [];
  const missed = new Uint8Array(frame.a.length);
  for (const pair of lost) missed[pair] = 1;
  return { step, missed, kept: step.kept ? await bytesOf(step.kept) : null };
}
