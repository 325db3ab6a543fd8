// The controls of a page: choose a method, its resolution, the visible parts of the scene, and a triangle.

// ---- state --------------------------------------------------------------------------------------

const methods = [...new Set(about.steps.map((step) => step.method))];
const state = { method: methods[0], resolution: Infinity, hidden: new Set(), axis: "", cut: 500, side: false,
  triangle: -1 };
let view = null, answer = null, loading = 0;

const stepsOf = (method) => about.steps.filter((step) => step.method === method);

// Returns the step of the chosen method with the resolution nearest to the requested resolution.
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
  byId("legend").replaceChildren(...rows.map(([colour, text]) => legendLine(css(colour), text)));
}

// Lists the pairs of the chosen triangle. Each pair is a button that chooses the other triangle.
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
    const plane = [0, 0, 0], sign = state.side ? -1 : 1;
    if (k >= 0) plane[k] = sign;
    view.uniforms.cut.value.set(...plane, k < 0 ? 1 : sign * state.cut / 1000);
    view.ask();
  }
}

// Loads the result of the chosen step, and shows it unless update() was called again meanwhile.
async function update() {
  const turn = ++loading;
  const step = currentStep();
  const given = answer && answer.step === step ? answer : await loadStep(step);
  if (turn !== loading) return;
  answer = given;
  showStates();
  showControls();
  showLegend();
  showChosen();
}

// ---- actions of the reader ----------------------------------------------------------------------

function choose(triangle, centred = false) {
  state.triangle = triangle;
  showStates();
  showChosen();
  if (view && centred && triangle >= 0) view.centre(triangle);
}

function hide(object, hidden) {
  if (hidden) state.hidden.add(object); else state.hidden.delete(object);
  const box = byId("list").querySelector(`[data-object="${object}"]`);
  if (box) box.checked = !hidden;
  if (view) view.hide(object, hidden);
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

// Chooses the next triangle with a missed pair. If the step missed no pair, chooses the next colliding triangle.
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

// ---- start --------------------------------------------------------------------------------------

function fillPage() {
  document.title = `${about.title}: collisions by farcull`;
  byId("title").textContent = about.title;
  byId("method").replaceChildren(...methods.map((m) => element("option", m, { value: m })));
  byId("about").textContent = `farcull ${about.commit.slice(0, 10)}; scene hash ${about.hash}; ` +
    `the flat picture: ${about.command}. ${about.notAsked}`;
  const longest = Math.max(...about.hi.map((x, k) => x - about.lo[k]));
  byId("rounding").textContent = `${Number((longest / 65535).toPrecision(2))} along the longest side of the scene, ` +
    "1/65,535 of it,";
}

function connectControls() {
  connect([
    ["method", "change", (e) => { state.method = e.target.value; update(); }],
    ["resolution", "input", (e) => { state.resolution = stepsOf(state.method)[e.target.value].resolution; update(); }],
    ["axis", "change", (e) => { state.axis = e.target.value; showControls(); }],
    ["cut", "input", (e) => { state.cut = Number(e.target.value); showControls(); }],
    ["side", "change", (e) => { state.side = e.target.checked; showControls(); }],
    ["reset", "click", resetView], ["show-all", "click", showAll], ["hide-idle", "click", showColliding],
    ["help", "click", () => byId("keys").showModal()]]);
}

const KEYS = {
  "[": () => setResolution(-1), "]": () => setResolution(1),
  m: () => { state.method = methods[(methods.indexOf(state.method) + 1) % methods.length]; update(); },
  n: next,
  h: () => { if (state.triangle >= 0) hide(frame.owner[state.triangle], true); },
  a: showAll,
  Escape: () => choose(-1),
  "?": () => byId("keys").showModal()
};

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
  const inControl = /^(INPUT|SELECT|BUTTON|SUMMARY)$/.test(event.target.tagName);
  const key = event.key;
  if (inControl && (key.startsWith("Arrow") || event.target.tagName === "SELECT")) return;
  if ("xyz".includes(key) && key.length === 1) {
    state.axis = state.axis === key ? "" : key;
    showControls();
  } else if (Object.hasOwn(KEYS, key)) {
    KEYS[key]();
  } else if (view && Object.hasOwn(VIEW_KEYS, key)) {
    VIEW_KEYS[key](event.shiftKey);
  } else {
    return;
  }
  event.preventDefault();
}

// Shows the flat picture instead of the scene. why: the reason, for the reader.
function standIn(why) {
  document.documentElement.classList.add("flat");
  byId("trouble").hidden = false;
  byId("trouble").textContent = why + " The flat picture stands in.";
  view = null;
}

async function start() {
  fillPage();
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
  frame = await loadFrame();
  if (view) view.setFrame(frame);
  showObjects();
  await update();
  connectControls();
  document.addEventListener("keydown", onKey);
  if (view) connectCanvas(); else markReady();
}

// Gives tests and the browser's console access to the state.
window.farcull = { about, state, get view() { return view; }, get frame() { return frame; }, get answer() { return answer; } };
start().catch((error) => {
  standIn(`The data of this page cannot be shown: ${error.message}.`);
  byId("headline").textContent = "";
  byId("controls").hidden = true;
  throw error;
});
