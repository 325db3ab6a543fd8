// Shows the list of pairs, and the scene. The two parts of the chosen pair have two colours, and the curve in which
// they intersect is drawn. All other parts are ghosts (see-through). The page's URL stores the chosen pair.

const MOST_LISTED = 1000;
const state = { row: -1, search: "", ghosts: true, through: false };
let view = null, curves = null, ends = null;

const nameOf = (object) => about.frame.objects[object][0];
const length = (x) => `${Number(x.toPrecision(6))}${about.unit ? " " + about.unit : ""}`;

// ---- the list -----------------------------------------------------------------------------------

function factsOf(row) {
  const out = [];
  if (row.ignored) out.push("ignored");
  if (row.depth) {
    const [lo, hi] = row.depth.map(length);
    out.push(lo === hi ? `depth ${lo}` : row.depth[0] > 0 ? `depth ${lo} to ${hi}` : `depth at most ${hi}`);
  }
  if (row.curve > 0) out.push(`curve ${length(row.curve)}`);
  if (row.distance !== null) out.push(`distance ${length(row.distance)}`);
  if (row.what) out.push(row.what);
  return out.join("; ");
}

// Returns a text such as "9 clash, 1 near". Ignored pairs are not counted.
function countsOf(rows) {
  const counts = new Map();
  for (const row of rows.filter((r) => !r.ignored)) counts.set(row.verdict, (counts.get(row.verdict) ?? 0) + 1);
  return [...counts].map(([verdict, n]) => `${digits.format(n)} ${verdict}`).join(", ");
}

const textOf = (row) => `${row.verdict} ${nameOf(row.a)} ${nameOf(row.b)}`.toLowerCase();
const listed = () => about.rows.map((row, k) => k).filter((k) => textOf(about.rows[k]).includes(state.search));

function showRows() {
  const numbers = listed();
  const items = numbers.slice(0, MOST_LISTED).map((k) => {
    const row = about.rows[k], item = element("li");
    const button = element("button", undefined, { type: "button" });
    button.dataset.row = k;
    button.append(element("b", row.verdict), ` ${nameOf(row.a)} and ${nameOf(row.b)}`, element("span", factsOf(row)));
    button.setAttribute("aria-current", String(k === state.row));
    button.addEventListener("click", () => chooseRow(k));
    item.append(button);
    return item;
  });
  if (numbers.length > MOST_LISTED) items.push(element("li", `and ${digits.format(numbers.length - MOST_LISTED)} others`));
  if (numbers.length === 0) items.push(element("li", about.rows.length === 0 ? "All pairs are clear." : "None."));
  byId("rows").replaceChildren(...items);
}

function showLegend() {
  const row = about.rows[state.row];
  const texts = row ? [nameOf(row.a), nameOf(row.b)]
    : ["in a pair that clashes, is contained or unknown", "the other parts"];
  const items = [about.colours.idle, about.colours.objects[0]].map((colour, k) => legendLine(css(colour), texts[k]));
  if (row && row.segments[1] > 0)
    items.push(legendLine("#dc005a", row.curve > 0 ? "the surfaces cross" : "between two nearest points"));
  byId("legend").replaceChildren(...items);
}

// ---- the scene ----------------------------------------------------------------------------------

const sizeOf = (object) => (view.boxes[object].isEmpty() ? 0 : view.boxes[object].getSize(new THREE.Vector3()).length());
const larger = (row) => (sizeOf(row.a) > sizeOf(row.b) ? row.a : row.b);
const outerOf = (row) => (row.inner === null ? larger(row) : row.inner === row.a ? row.b : row.a);

// If no pair is chosen, parts that clash or may contain each other have the first colour. If a pair is chosen,
// its parts are solid. But a part that contains the other part is a ghost (see-through). The larger part is also
// a ghost if the reader has chosen to see through.
function showParts() {
  if (!view) return;
  const row = about.rows[state.row], states = new Uint8Array(frame.triangles);
  const outer = row && (state.through || row.inner !== null) ? outerOf(row) : -1;
  const bad = new Set(about.rows.filter((r) => !r.ignored && r.verdict !== "touch" && r.verdict !== "near").flatMap((r) => [r.a, r.b]));
  frame.objects.forEach(([, first, count], o) => {
    const solid = row === undefined || o === row.a || o === row.b;
    if (row ? o === row.a : bad.has(o)) states.fill(IDLE, first, first + count);
    view.ghost(o, !solid || o === outer, !state.ghosts && !solid);
  });
  view.setStates(states);
  showCurve(row);
}

function pointOf(list, k) {
  const n = list.length / 3, ratio = view.uniforms.ratio.value;
  return new THREE.Vector3(list[k], list[n + k], list[2 * n + k]).multiplyScalar(2 / 65535).subScalar(1).multiply(ratio);
}

function showCurve(row) {
  if (curves) {
    view.scene.remove(curves);
    curves.geometry.dispose();
    curves = null;
  }
  if (!row || row.segments[1] === 0 || view.uniforms.explode.value > 0) return;
  const [first, count] = row.segments, points = [];
  for (let k = 2 * first; k < 2 * (first + count); ++k) points.push(pointOf(ends, k));
  const material = new THREE.LineBasicMaterial({ color: 0xdc005a, depthTest: false, depthWrite: false });
  curves = new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(points), material);
  curves.renderOrder = 9;
  curves.frustumCulled = false;
  view.scene.add(curves);
}

// Moves and zooms the view to the pair of a row, without turning. If one part contains the other part, the view
// shows the complete outer part.
function flyTo(row) {
  const lo = pointOf(row.box, 0), hi = pointOf(row.box, 1), middle = lo.clone().add(hi).multiplyScalar(0.5);
  const size = Math.max(0.01, 2 * hi.sub(lo).length(), 1.3 * (row.inner === null ? Math.min(sizeOf(row.a), sizeOf(row.b)) : sizeOf(outerOf(row))));
  const from = view.controls.target.clone(), zoom = view.camera.zoom, to = Math.min(2 / size, 200);
  const offset = view.camera.position.clone().sub(from), begin = performance.now();
  const step = () => {
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const part = calm ? 1 : Math.min(1, (performance.now() - begin) / 350), s = part * part * (3 - 2 * part);
    view.controls.target.lerpVectors(from, middle, s);
    view.camera.position.copy(view.controls.target).add(offset);
    view.camera.zoom = zoom * (to / zoom) ** s;
    view.camera.updateProjectionMatrix();
    view.controls.update();
    view.ask();
    if (part < 1) requestAnimationFrame(step);
  };
  step();
}

// ---- actions of the reader ----------------------------------------------------------------------

function chooseRow(k) {
  state.row = k;
  for (const button of byId("rows").querySelectorAll("button")) {
    const chosen = Number(button.dataset.row) === k;
    button.setAttribute("aria-current", String(chosen));
    // Scrolls only the list. Scrolling the page would move the scene out of sight on a narrow screen.
    if (chosen) byId("rows").scrollTop = button.offsetTop - 40;
  }
  showParts();
  showLegend();
  if (view && k >= 0) flyTo(about.rows[k]);
  history.replaceState(null, "", k < 0 ? "#" : `#row=${k}`);
}

function go(by) {
  const numbers = listed();
  if (numbers.length === 0) return;
  const at = numbers.indexOf(state.row);
  chooseRow(numbers[at < 0 ? (by > 0 ? 0 : numbers.length - 1) : (at + by + numbers.length) % numbers.length]);
}

// The first click on a part chooses the part's first pair. Each further click chooses its next pair.
function choose(triangle) {
  if (triangle < 0) return;
  const o = frame.owner[triangle], numbers = listed().filter((k) => about.rows[k].a === o || about.rows[k].b === o);
  if (numbers.length > 0) chooseRow(numbers[(numbers.indexOf(state.row) + 1) % numbers.length]);
}

function readAddress() {
  const row = Number(new URLSearchParams(location.hash.slice(1)).get("row") ?? NaN);
  if (Number.isInteger(row) && row >= 0 && row < about.rows.length) chooseRow(row);
}

function standIn(why) {
  byId("trouble").hidden = false;
  byId("trouble").textContent = why + " The list has all answers.";
  view = null;
}

const KEYS = { ...VIEW_KEYS, n: () => go(1), p: () => go(-1), Escape: () => chooseRow(-1) };

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "INPUT") return;
  if (!view || !Object.hasOwn(KEYS, event.key)) return;
  KEYS[event.key](event.shiftKey);
  event.preventDefault();
}

function connectControls() {
  connect([
    ["search", "input", (e) => { state.search = e.target.value.trim().toLowerCase(); showRows(); }],
    ["ghosts", "change", (e) => { state.ghosts = e.target.checked; showParts(); }],
    ["through", "change", (e) => { state.through = e.target.checked; showParts(); }],
    ["explode", "input", (e) => {
      byId("explode-value").textContent = `${e.target.value} %`;
      if (!view) return;
      view.uniforms.explode.value = e.target.value / 100;
      showParts();
    }],
    ["reset", "click", () => { chooseRow(-1); if (view) resetView(); }]]);
  document.addEventListener("keydown", onKey);
  window.addEventListener("hashchange", readAddress);
}

async function start() {
  document.title = `${about.title}: clashes by farcull`;
  byId("title").textContent = about.title;
  byId("headline").textContent = `${digits.format(about.examined)} of ${digits.format(about.asked)} pairs of parts examined` +
    ["", about.clean ? "clean" : countsOf(about.rows)].filter((part, k) => k === 0 || part).join("; ");
  byId("about").textContent = `farcull ${about.commit.slice(0, 10)}.`;
  showRows();
  showLegend();
  connectControls();
  try {
    view = new SceneView(byId("canvas"), about);
    frame = await loadFrame();
    ends = await numbersOf(about.segments);
    view.setFrame(frame);
    connectCanvas();
    showParts();
    readAddress();
  } catch (error) {
    standIn(`${error.message}`);
    document.documentElement.dataset.ready = "0";
  }
}

// Gives tests and the browser's console access to the state.
window.farcull = { about, state, get view() { return view; } };
start();
