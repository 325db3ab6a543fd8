// The controls of the page: the answer, the visible parts of the scene, and the clicked triangle.
// The address holds all choices behind the #, so that an address reproduces a view.

const byId = (id) => document.getElementById(id);
const about = JSON.parse(byId("data").textContent);
const digits = new Intl.NumberFormat("en");

// ---- state --------------------------------------------------------------------------------------

const methods = [...new Set(about.steps.map((step) => step.method))];
const state = { method: methods[0], resolution: Infinity, frame: 0, hidden: new Set(), explode: 0, axis: "", cut: 500,
  side: false, triangle: -1, theme: "" };
let view = null, answer = null, loading = 0, shownFrame = -1;

function stepsOf(method) {
  return about.steps.filter((step) => step.method === method && step.frame === state.frame);
}

// The step of the state, at the resolution nearest to the requested one.
function currentStep() {
  const steps = stepsOf(state.method);
  const far = (step) => Math.abs(step.resolution - Math.min(state.resolution, 1e9));
  return steps.reduce((best, step) => (far(step) < far(best) ? step : best));
}

// ---- display ------------------------------------------------------------------------------------

function nameOf(triangle) {
  const o = frame.owner[triangle], [name, first] = frame.objects[o];
  return `triangle ${digits.format(triangle - first)} of object ${o}, ${name}`;
}

function counted(n, one, more) { return `${digits.format(n)} ${n === 1 ? one : more}`; }

function css(colour) { return `rgb(${colour.join(", ")})`; }

function element(tag, text, properties) {
  const out = Object.assign(document.createElement(tag), properties);
  if (text !== undefined) out.textContent = text;
  return out;
}

function showLegend() {
  const step = answer.step, c = about.colours;
  const idle = c.objects[0].map((x, i) => Math.round(x + (c.idle[i] - x) * c.idlePart));
  const pairs = frame.a.length;
  const rows = [[c.found, `collide and found: ${counted(pairs - step.missedPairs, "pair", "pairs")}`]];
  if (step.missedPairs > 0) {
    rows.push([c.missed,
      `missed: ${counted(step.missedPairs, "pair", "pairs")} of ${counted(step.missedTriangles, "triangle", "triangles")}`]);
  }
  if (step.culls) rows.push([idle, `kept, collide with nothing: ${counted(step.idle, "triangle", "triangles")}`]);
  byId("legend").replaceChildren(...rows.map(([colour, text]) => {
    const row = element("li"), box = element("i");
    box.style.background = css(colour);
    row.append(box, text);
    return row;
  }));
}

// The pairs of the chosen triangle, each a button that chooses the other triangle.
const MOST_SHOWN = 200;
function showChosen() {
  const box = byId("chosen");
  if (state.triangle < 0) {
    box.replaceChildren(element("p", "Click a triangle for its pairs."));
    return;
  }
  const pairs = pairsOf(state.triangle), lost = pairs.filter((p) => answer.missed[p]).length;
  const name = nameOf(state.triangle), list = element("ul");
  for (const p of pairs.slice(0, MOST_SHOWN)) {
    const other = frame.a[p] === state.triangle ? frame.b[p] : frame.a[p];
    const row = element("li"), missed = answer.missed[p] !== 0;
    const button = element("button", nameOf(other) + ": ", { type: "button" });
    button.dataset.triangle = other;
    button.append(element("span", about.contacts[frame.contacts[p]] + (missed ? ", missed" : ", found"),
      { className: missed ? "missed" : "" }));
    button.addEventListener("click", () => choose(other));
    row.append(button);
    list.append(row);
  }
  const told = [element("p", name[0].toUpperCase() + name.slice(1))];
  told.push(element("p", pairs.length === 0
    ? (isKept(state.triangle) ? "It collides with nothing, and the method kept it." : "It collides with nothing.")
    : `It collides with ${counted(pairs.length, "triangle", "triangles")}` +
      (lost === 0 ? ":" : pairs.length === 1 ? `; ${answer.step.title} misses this pair:`
        : `; ${answer.step.title} misses ${digits.format(lost)} of these pairs:`),
    { className: lost > 0 ? "missed" : "" }));
  if (pairs.length > 0) told.push(list);
  if (pairs.length > MOST_SHOWN)
    told.push(element("p", `and ${digits.format(pairs.length - MOST_SHOWN)} others`));
  box.replaceChildren(...told);
}

function pairsOf(triangle) {
  const out = [];
  for (let p = 0; p < frame.a.length; ++p)
    if (frame.a[p] === triangle || frame.b[p] === triangle) out.push(p);
  return out;
}

function isKept(triangle) {
  return answer.kept !== null && (answer.kept[triangle >> 3] >> (triangle & 7) & 1) !== 0;
}

function showStates() {
  const states = new Uint8Array(frame.triangles);
  for (let t = 0; t < frame.triangles; ++t) states[t] = isKept(t) ? IDLE : REST;
  for (let p = 0; p < frame.a.length; ++p) {
    const bits = answer.missed[p] ? COLLIDES | MISSED : COLLIDES;
    states[frame.a[p]] |= bits;
    states[frame.b[p]] |= bits;
  }
  if (state.triangle >= 0) {
    states[state.triangle] |= CHOSEN;
    for (const p of pairsOf(state.triangle))
      states[frame.a[p] === state.triangle ? frame.b[p] : frame.a[p]] |= PARTNER;
  }
  if (view) view.setStates(states);
}

const MOST_LISTED = 1000;
function showObjects() {
  const listed = frame.objects.slice(0, MOST_LISTED).map(([name, , count], o) => {
    const row = element("li"), label = element("label"), colour = element("i");
    const box = element("input", undefined, { type: "checkbox", checked: !state.hidden.has(o) });
    box.dataset.object = o;
    box.addEventListener("change", () => hide(o, !box.checked));
    const colours = about.colours.objects;
    colour.style.background = css(colours[o % colours.length]);
    label.append(box, colour, `${o}: ${name} (${digits.format(count)})`);
    row.append(label);
    return row;
  });
  const others = frame.objects.length - listed.length;
  if (others > 0) listed.push(element("li", `and ${digits.format(others)} others, which h hides`));
  byId("list").replaceChildren(...listed);
  frame.objects.forEach((object, o) => view && view.hide(o, state.hidden.has(o)));
}

function showControls() {
  const steps = stepsOf(state.method), step = answer.step;
  byId("method").value = state.method;
  byId("resolution").max = steps.length - 1;
  byId("resolution").value = steps.indexOf(step);
  const has = step.resolution > 0;
  byId("resolution").hidden = byId("resolution-label").hidden = !has;
  byId("resolution-value").textContent = has ? `${step.resolution} px` : "";
  const moves = about.frames.length > 1;
  byId("frame").hidden = byId("frame-label").hidden = byId("play").hidden = !moves;
  byId("frame").value = state.frame;
  byId("frame-value").textContent = about.frames[state.frame].frame ?? "";
  byId("explode").value = Math.round(100 * state.explode);
  byId("explode-value").textContent = `${Math.round(100 * state.explode)} %`;
  byId("axis").value = state.axis;
  byId("cut").value = state.cut;
  byId("side").checked = state.side;
  byId("cut").hidden = byId("cut-label").hidden = byId("side-label").hidden = state.axis === "";
  const k = ["x", "y", "z"].indexOf(state.axis);
  byId("cut-value").textContent = k < 0 ? "" :
    `${state.axis} = ${Number((about.lo[k] + (about.hi[k] - about.lo[k]) * state.cut / 1000).toPrecision(5))}`;
  const headline = byId("headline");
  headline.textContent = `${step.title}: ${step.headline}`;
  headline.className = step.missedPairs > 0 ? "missed" : "";
  if (view) {
    view.uniforms.explode.value = state.explode;
    const plane = [0, 0, 0], sign = state.side ? -1 : 1;
    if (k >= 0) plane[k] = sign;
    view.uniforms.cut.value.set(...plane, k < 0 ? 1 : sign * state.cut / 1000);
    view.ask();
  }
}

// Loads and shows the answer for the state. If another answer was requested meanwhile, shows that
// one.
async function update() {
  const turn = ++loading;
  const of = await loadFrame(state.frame);
  const step = currentStep();
  const given = answer && answer.step === step ? answer : await loadStep(step, of);
  if (turn !== loading) return;
  const changed = shownFrame !== state.frame, topology = !frame || frame.given !== of.given;
  frame = of;
  answer = given;
  shownFrame = state.frame;
  if (state.triangle >= frame.triangles) state.triangle = -1;
  if (changed && view) view.setFrame(frame.corners, frame.positions, frame.owner, frame.objects);
  if (topology) showObjects();
  showStates();
  showControls();
  showLegend();
  showChosen();
  writeAddress();
}

// ---- actions of the reader ----------------------------------------------------------------------

function choose(triangle, centred = false) {
  state.triangle = triangle;
  showStates();
  showChosen();
  writeAddress();
  if (view && centred && triangle >= 0) view.centre(triangle);
}

function hide(object, hidden) {
  if (hidden) state.hidden.add(object); else state.hidden.delete(object);
  const box = byId("list").querySelector(`[data-object="${object}"]`);
  if (box) box.checked = !hidden;
  if (view) view.hide(object, hidden);
  writeAddress();
}

function showAll() {
  for (const o of [...state.hidden]) hide(o, false);
}

function showColliding() {
  const hit = new Set();
  for (let p = 0; p < frame.a.length; ++p) hit.add(frame.owner[frame.a[p]]).add(frame.owner[frame.b[p]]);
  frame.objects.forEach((object, o) => hide(o, !hit.has(o)));
}

function setResolution(by) {
  const steps = stepsOf(state.method), at = steps.indexOf(answer.step);
  state.resolution = steps[Math.min(steps.length - 1, Math.max(0, at + by))].resolution;
  update();
}

function setFrame(number) {
  state.frame = Math.min(about.frames.length - 1, Math.max(0, number));
  return update();
}

// Chooses the next missed triangle after the chosen one; a colliding one if none is missed.
function next() {
  let first = -1, after = -1;
  const any = answer.step.missedPairs === 0;
  for (let p = 0; p < frame.a.length; ++p) {
    if (!any && !answer.missed[p]) continue;
    for (const t of [frame.a[p], frame.b[p]]) {
      if (first < 0 || t < first) first = t;
      if (t > state.triangle && (after < 0 || t < after)) after = t;
    }
  }
  const found = after >= 0 ? after : first;
  if (found >= 0) choose(found, true);
}

function setTheme(theme) {
  state.theme = theme;
  if (theme) document.documentElement.dataset.theme = theme;
  else delete document.documentElement.dataset.theme;
  if (view) {
    view.paper = new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue("--paper").trim());
    view.ask();
  }
  writeAddress();
}

function isDark() {
  return state.theme ? state.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

// Plays the frames; a frame that is slow to unpack delays the next one. `plays` is odd meanwhile.
let plays = 0;
async function play() {
  const turn = ++plays;
  byId("play").textContent = turn % 2 === 1 ? "Stop" : "Play the frames";
  while (turn % 2 === 1 && turn === plays) {
    await setFrame((state.frame + 1) % about.frames.length);
    await new Promise((done) => setTimeout(done, 200));
  }
}

// ---- the address --------------------------------------------------------------------------------

const short = (x) => Number(x.toPrecision(5));

function addressOf() {
  const out = new URLSearchParams();
  out.set("method", state.method);
  if (answer.step.resolution) out.set("px", answer.step.resolution);
  if (about.frames.length > 1) out.set("frame", about.frames[state.frame].frame);
  if (state.hidden.size > 0) out.set("hide", [...state.hidden].sort((a, b) => a - b).join("."));
  if (state.explode > 0) out.set("explode", state.explode);
  if (state.axis) out.set("cut", `${state.side ? "-" : ""}${state.axis}${state.cut}`);
  if (state.triangle >= 0) out.set("triangle", state.triangle);
  if (state.theme) out.set("theme", state.theme);
  if (view) {
    const target = view.controls.target;
    const offset = view.camera.position.clone().sub(target).normalize();
    out.set("eye", offset.toArray().map(short).join("_"));
    out.set("middle", target.toArray().map(short).join("_"));
    out.set("zoom", short(view.camera.zoom));
  }
  return "#" + out.toString();
}

let writing = 0, written = location.hash;
function writeAddress() {
  if (!answer) return;  // nothing is shown yet
  clearTimeout(writing);
  writing = setTimeout(() => {
    written = addressOf();
    history.replaceState(null, "", written);
  }, 250);
}

const finite = (list) => list.length === 3 && list.every(Number.isFinite);

// Applies the parts of the address that this page can show, and ignores the rest. An address may be
// anything.
function readAddress() {
  const given = new URLSearchParams(location.hash.slice(1));
  const number = (name, least, most) => {
    const x = given.has(name) ? Number(given.get(name)) : NaN;
    return Number.isFinite(x) && x >= least && x <= most ? x : undefined;
  };
  if (methods.includes(given.get("method"))) state.method = given.get("method");
  state.resolution = number("px", 1, 1e9) ?? state.resolution;
  const at = about.frames.findIndex((f) => String(f.frame) === given.get("frame"));
  if (at >= 0) state.frame = at;
  state.hidden = new Set((given.get("hide") ?? "").split(".").filter((x) => /^\d{1,6}$/.test(x)).map(Number));
  state.explode = number("explode", 0, 1) ?? 0;
  const cut = /^(-?)([xyz])(\d{1,4})$/.exec(given.get("cut") ?? "");
  state.axis = cut ? cut[2] : "";
  state.side = cut !== null && cut[1] === "-";
  if (cut) state.cut = Math.min(1000, Number(cut[3]));
  const triangle = number("triangle", 0, 4294967295);
  state.triangle = triangle !== undefined && Number.isInteger(triangle) ? triangle : -1;
  if (["light", "dark"].includes(given.get("theme"))) setTheme(given.get("theme"));
  return given;
}

function readCamera(given) {
  if (!view) return;
  const list = (name) => (given.get(name) ?? "").split("_").map(Number);
  const eye = list("eye"), middle = list("middle"), zoom = Number(given.get("zoom"));
  if (!given.has("eye") || !finite(eye) || !finite(middle) || !(zoom > 0 && zoom < 1e6)) return;
  const offset = new THREE.Vector3().fromArray(eye);
  if (!(offset.length() > 1e-3)) return;
  view.controls.target.fromArray(middle);
  view.camera.position.copy(view.controls.target).add(offset.setLength(30));
  view.camera.zoom = zoom;
  view.resize();
  view.controls.update();
}

// ---- start --------------------------------------------------------------------------------------

function fillPage() {
  document.title = `${about.title}: collisions by farcull`;
  byId("title").textContent = about.title;
  byId("method").replaceChildren(...methods.map((m) => element("option", m, { value: m })));
  byId("frame").max = about.frames.length - 1;
  byId("about").textContent = `farcull ${about.commit.slice(0, 10)}; scene hash ${about.hash}; ` +
    `the flat picture: ${about.command}. ${about.notAsked}`;
  const longest = Math.max(...about.hi.map((x, k) => x - about.lo[k]));
  byId("rounding").textContent = `${Number((longest / 65535).toPrecision(2))} along the longest side of the scene, ` +
    "1/65,535 of it,";
  byId("licence-text").textContent = byId("three-licence").textContent.trim();
}

function connectControls() {
  const on = (id, event, act) => byId(id).addEventListener(event, act);
  on("method", "change", (e) => { state.method = e.target.value; update(); });
  on("resolution", "input", (e) => { state.resolution = stepsOf(state.method)[e.target.value].resolution; update(); });
  on("frame", "input", (e) => setFrame(Number(e.target.value)));
  on("play", "click", play);
  on("explode", "input", (e) => { state.explode = e.target.value / 100; showControls(); writeAddress(); });
  on("axis", "change", (e) => { state.axis = e.target.value; showControls(); writeAddress(); });
  on("cut", "input", (e) => { state.cut = Number(e.target.value); showControls(); writeAddress(); });
  on("side", "change", (e) => { state.side = e.target.checked; showControls(); writeAddress(); });
  on("reset", "click", resetView);
  on("show-all", "click", showAll);
  on("hide-idle", "click", showColliding);
  on("theme", "click", () => setTheme(isDark() ? "light" : "dark"));
  on("help", "click", () => byId("keys").showModal());
  on("licence-button", "click", () => byId("licence").showModal());
  on("link", "click", copyLink);
  on("controls", "submit", (e) => e.preventDefault());
}

async function copyLink() {
  history.replaceState(null, "", addressOf());
  try {
    await navigator.clipboard.writeText(location.href);
    byId("link").textContent = "Copied";
  } catch (refused) {
    byId("link").textContent = "Copy it from the address bar";
  }
  setTimeout(() => { byId("link").textContent = "Copy a link"; }, 2000);
}

const KEYS = {
  "[": () => setResolution(-1), "]": () => setResolution(1),
  m: () => { state.method = methods[(methods.indexOf(state.method) + 1) % methods.length]; update(); },
  ",": () => setFrame(state.frame - 1), ".": () => setFrame(state.frame + 1),
  n: next,
  h: () => { if (state.triangle >= 0) hide(frame.owner[state.triangle], true); },
  a: showAll,
  e: () => { state.explode = state.explode >= 1 ? 0 : Math.min(1, short(state.explode + 0.25)); showControls(); writeAddress(); },
  t: () => setTheme(isDark() ? "light" : "dark"),
  Escape: () => choose(-1),
  "?": () => byId("keys").showModal()
};
const VIEW_KEYS = {
  ArrowLeft: (shift) => (shift ? view.move(-0.05, 0) : view.turn(-0.1, 0)),
  ArrowRight: (shift) => (shift ? view.move(0.05, 0) : view.turn(0.1, 0)),
  ArrowUp: (shift) => (shift ? view.move(0, 0.05) : view.turn(0, 0.1)),
  ArrowDown: (shift) => (shift ? view.move(0, -0.05) : view.turn(0, -0.1)),
  "+": () => view.zoom(1.2), "=": () => view.zoom(1.2), "-": () => view.zoom(1 / 1.2), 0: resetView
};

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
  const inControl = /^(INPUT|SELECT|BUTTON|SUMMARY)$/.test(event.target.tagName);
  const key = event.key;
  if (inControl && (key.startsWith("Arrow") || event.target.tagName === "SELECT")) return;
  if ("xyz".includes(key) && key.length === 1) {
    state.axis = state.axis === key ? "" : key;
    showControls();
    writeAddress();
  } else if (Object.hasOwn(KEYS, key)) {
    KEYS[key]();
  } else if (view && Object.hasOwn(VIEW_KEYS, key)) {
    VIEW_KEYS[key](event.shiftKey);
    writeAddress();
  } else {
    return;
  }
  event.preventDefault();
}

// Shows the flat picture in place of the scene, and why.
function standIn(why) {
  document.documentElement.classList.add("flat");
  byId("trouble").hidden = false;
  byId("trouble").textContent = why + " The flat picture stands in.";
  view = null;
}

async function start() {
  fillPage();
  const given = readAddress();
  if (typeof DecompressionStream === "undefined") {
    standIn("This browser is too old to unpack the scene.");
    byId("headline").textContent = "";
    byId("controls").hidden = true;
    return;
  }
  try {
    view = new SceneView(byId("canvas"), about);
  } catch (error) {
    standIn(error.message);
  }
  await update();
  connectControls();
  document.addEventListener("keydown", onKey);
  if (view) {
    connectCanvas();
    resetView();
    readCamera(given);
    setTheme(state.theme);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => setTheme(state.theme));
    view.onDraw = () => {
      view.onDraw = () => {};
      document.documentElement.dataset.ready = String(Math.round(performance.now()));
    };
  } else {
    document.documentElement.dataset.ready = String(Math.round(performance.now()));
  }
  window.addEventListener("hashchange", async () => {
    if (location.hash === written) return;
    const other = readAddress();
    await update();
    showObjects();
    readCamera(other);
  });
}

// For tests and the console.
window.farcull = { about, state, get view() { return view; }, get frame() { return frame; }, get answer() { return answer; } };
start().catch((error) => {
  standIn(`The data of this page cannot be shown: ${error.message}.`);
  byId("headline").textContent = "";
  byId("controls").hidden = true;
  throw error;
});
