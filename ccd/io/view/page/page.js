// Pairs of the step, then intersections at its start.
const NAMES = ["vertex_face", "edge_edge", "vertex_edge", "vertex_vertex", "start_face_face", "start_edge_face",
  "start_vertex_face", "start_edge_edge", "start_vertex_edge", "start_vertex_vertex"];
const SHORT = ["vf", "ee", "ve", "vv", "ff", "ef", "vf", "ee", "ve", "vv"], WORDS = ["vertex", "edge", "face"];
const FIRST = [1, 2, 1, 1, 3, 2, 1, 2, 1, 1], POINTS = [4, 4, 3, 2, 6, 5, 4, 4, 3, 2];  // of the first element, of both
const STEP_KINDS = 4;
const RELATIONS = ["disjoint", "touching", "overlapping", "crossing"];
const BOXES = ["faces", "wires", "pairs", "through", "cut"];
const ROW = 22;                                     // pixels, as in the style
const TALLEST = 8e6;                                // limit of browsers for an element's height

const element = id => document.getElementById(id);

function bytes(id) {
  const text = atob(element("array-" + id).textContent.trim()), found = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) found[i] = text.charCodeAt(i);
  return found.buffer;
}

/// All pairs are one after the other, by kind. `times` is empty if they are unknown. Intersections have relations.
function readStep() {
  const step = {before: new Float64Array(bytes("before")), after: new Float64Array(bytes("after")),
    faces: new Uint32Array(bytes("faces")), edges: new Uint32Array(bytes("edges")), parts: new Uint8Array(bytes("parts")),
    motions: new Float64Array(bytes("motions")), ends: new Uint32Array(bytes("ends"))};
  step.turns = step.ends.length > 0;
  if (step.turns) {
    step.rest = step.before;
    [step.before, step.after] = [0, 1].map(t => positionsAt(step, t));
  }
  step.kinds = NAMES.map((name, k) => {
    const vertices = new Uint32Array(bytes(name)), count = vertices.length / POINTS[k];
    if (k >= STEP_KINDS)
      return {vertices, count, times: new Float64Array(2 * count), contacts: new Float32Array(),
        relations: new Uint8Array(bytes(name + "_relations")), segments: new Float64Array(bytes(name + "_segments"))};
    return {vertices, count, times: new Float64Array(bytes(name + "_times")),
      contacts: new Float32Array(bytes(name + "_contacts"))};
  });
  step.kinds.reduce((first, kind) => (kind.first = first) + kind.count, 0);
  step.count = step.kinds.reduce((sum, kind) => sum + kind.count, 0);
  step.pairs = step.kinds[STEP_KINDS].first;
  step.moves = step.turns || step.before.some((c, i) => c !== step.after[i]);
  step.timed = step.kinds.some((kind, k) => k < STEP_KINDS && kind.times.length > 0);
  return step;
}

/// Kind and vertices of a pair, and its times, weights and normal if they are known. An intersection has a relation
/// and a segment, of NaN if it is unknown.
function pairOf(step, i) {
  let k = 0;
  while (i >= step.kinds[k].count) i -= step.kinds[k++].count;
  const {vertices, times, contacts, relations, segments} = step.kinds[k], contact = Array.from(contacts.subarray(7 * i, 7 * i + 7));
  const all = Array.from(vertices.subarray(POINTS[k] * i, POINTS[k] * (i + 1)));
  return {kind: k, vertices: all, elements: [all.slice(0, FIRST[k]), all.slice(FIRST[k])],
    low: times[2 * i], high: times[2 * i + 1], weights: contact.slice(0, POINTS[k]), normal: contact.slice(4),
    relation: relations && RELATIONS[relations[i]], segment: segments && Array.from(segments.subarray(6 * i, 6 * i + 6))};
}

/// The picture's coordinates: floats, relative to the middle of both frames and to their largest extent.
function sceneOf(step) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  const times = [0, 1, 2, 3, 4, 5, 6, 7, 8].map(i => i / 8);
  for (const frame of step.turns ? times.map(t => positionsAt(step, t)) : [step.before, step.after])
    frame.forEach((c, i) => {
      low[i % 3] = Math.min(low[i % 3], c);
      high[i % 3] = Math.max(high[i % 3], c);
    });
  const middle = low.map((c, a) => c / 2 + high[a] / 2);
  const half = Math.max(...low.map((c, a) => high[a] / 2 - c / 2)) || 1;
  const scaled = frame => Float32Array.from(frame, (c, i) => (c - middle[i % 3]) / half);
  const scene = {scaled, before: scaled(step.before), after: scaled(step.after), faces: step.faces, parts: step.parts,
    rods: step.edges, points: pointsOf(step), marks: marksOf(step, scaled(step.before), scaled(step.after)),
    struck: elementsOf(step, 0, 3), crossed: elementsOf(step, 1, 2), meeting: edgesAtStart(step)};
  scene.edgeLength = typicalLength(scene);
  return scene;
}

function pointsOf(step) {
  const used = new Uint8Array(step.before.length / 3);
  for (const list of [step.faces, step.edges]) list.forEach(v => used[v] = 1);
  return Uint32Array.from(used.keys()).filter(v => !used[v]);
}

/// The faces (size 3) or edges (size 2) of all pairs of a kind, each once.
function elementsOf(step, k, size) {
  const found = new Map();
  for (let i = 0; i < step.kinds[k].count; ++i)
    for (const element of pairOf(step, i + step.kinds[k].first).elements)
      if (element.length === size) found.set(element.join(), element);
  return Uint32Array.from([...found.values()].flat());
}

/// The edges of all elements that intersect at the start, each once.
function edgesAtStart(step) {
  const found = new Map();
  for (let i = step.pairs; i < step.count; ++i)
    for (const ends of pairOf(step, i).elements.map(edgesOf))
      for (let k = 0; k < ends.length; k += 2) {
        const edge = ends.slice(k, k + 2).sort((v, w) => v - w);
        found.set(edge.join(), edge);
      }
  return Uint32Array.from([...found.values()].flat());
}

/// A mark for each pair: at its vertex, or in the middle of its two edges or of an intersection's vertices.
function marksOf(step, before, after) {
  const marks = {before: new Float32Array(3 * step.count), after: new Float32Array(3 * step.count),
    kinds: new Uint8Array(step.count)};
  for (let i = 0; i < step.count; ++i) {
    const pair = pairOf(step, i), at = pair.kind === 1 || pair.relation ? pair.vertices : pair.elements[0];
    marks.kinds[i] = Math.min(pair.kind, STEP_KINDS);
    for (let a = 0; a < 3; ++a)
      for (const v of at) {
        marks.before[3 * i + a] += before[3 * v + a] / at.length;
        marks.after[3 * i + a] += after[3 * v + a] / at.length;
      }
  }
  return marks;
}

/// The mean over some faces' and rods' edges.
function typicalLength(scene) {
  const list = scene.faces.length ? scene.faces : scene.rods, size = scene.faces.length ? 3 : 2;
  const stride = size * Math.max(1, Math.floor(list.length / size / 1000));
  let sum = 0, count = 0;
  for (let i = 0; i + 1 < list.length; i += stride, ++count)
    sum += Math.hypot(...[0, 1, 2].map(a => scene.before[3 * list[i] + a] - scene.before[3 * list[i + 1] + a]));
  return sum / count || .05;
}

const step = readStep();
const scene = sceneOf(step);
const camera = new Camera(element("up").selectedIndex);
let picture = null, order = Uint32Array.from({length: step.count}, (_, i) => i), chosen = -1, waiting = false;

const time = () => Number(element("time").value);

function redraw() {
  if (!picture || waiting) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    const show = Object.fromEntries(BOXES.map(id => [id, element(id).checked]));
    picture.show(camera, time(), show);
  });
}

/// Moves bodies that turn. All else moves along straight lines from `before` to `after`.
function moveTo(t) {
  if (!step.turns) return;
  scene.before = scene.after = scene.scaled(positionsAt(step, t));
  scene.marks = marksOf(step, scene.before, scene.after);
  if (picture) picture.update();
}

function setTime(t) {
  moveTo(t);
  element("time").value = t;
  element("shown-time").textContent = String(t);
  redraw();
}

// The list. Only the visible rows exist.

function inSight() { return Math.max(1, Math.floor(element("list").clientHeight / ROW)); }

/// How far the list scrolls, in pixels and in rows.
function reach() {
  const list = element("list");
  return {pixels: Math.max(1, list.scrollHeight - list.clientHeight), rows: Math.max(0, order.length - inSight())};
}

function rowOf(i, place) {
  const pair = pairOf(step, i), row = document.createElement("div");
  const add = (kind, text) => row.appendChild(Object.assign(document.createElement("span"), {className: kind, textContent: text}));
  row.className = "row";
  row.id = "pair-" + i;
  row.setAttribute("role", "option");
  row.setAttribute("aria-selected", i === chosen);
  row.setAttribute("aria-setsize", order.length);
  row.setAttribute("aria-posinset", place + 1);
  add("number", i);
  add("kind " + (pair.relation ? "start" : SHORT[pair.kind]), SHORT[pair.kind]);
  add("vertices", pair.elements.map(e => e.join(" ")).join(" | "));
  if (pair.relation) add("low", pair.relation);
  else if (step.timed) add("low", pair.high === 0 ? "at start" : pair.low.toPrecision(6));
  row.onclick = () => choose(i);
  return row;
}

function showRows() {
  const {pixels, rows} = reach(), first = Math.round(element("list").scrollTop / pixels * rows);
  const places = Array.from(order.subarray(first, first + inSight()).keys(), place => first + place);
  element("rows").replaceChildren(...places.map(place => rowOf(order[place], place)));
}

function showList() {
  const height = order.length * ROW;
  element("height").style.height = Math.min(height, TALLEST) + "px";
  element("list").scrollTop = 0;
  element("chosen").textContent = order.length === step.count ? "" : order.length + " of them";
  showRows();
}

function arrange() {
  const vertex = element("vertex").value;
  let found = Array.from({length: step.count}, (_, i) => i);
  if (vertex !== "") found = found.filter(i => pairOf(step, i).vertices.includes(Number(vertex)));
  if (element("order").value === "time") {
    const lows = Float64Array.from({length: step.count}, (_, i) => pairOf(step, i).low);
    found.sort((i, j) => lows[i] - lows[j] || i - j);
  }
  order = Uint32Array.from(found);
  showList();
}

function reveal(place) {
  const {pixels, rows} = reach(), list = element("list");
  const first = Math.round(list.scrollTop / pixels * rows);
  if (place >= first && place < first + inSight()) return;
  list.scrollTop = rows ? Math.min(rows, Math.max(0, place - Math.floor(inSight() / 2))) / rows * pixels : 0;
}

// The chosen pair.

function said(elements) {
  return elements.map(e => WORDS[e.length - 1] + " " + e.join(" ")).join(" and ");
}

function whenOf(pair) {
  if (pair.relation) return pair.relation[0].toUpperCase() + pair.relation.slice(1) + (step.moves ? " at the start." : ".");
  if (!step.timed) return "The first time was not computed.";
  if (pair.high === 0) return "In contact at the start.";
  return pair.low === pair.high ? `First at t = ${pair.low}.` : `First between t = ${pair.low} and ${pair.high}.`;
}

/// All weights are 0 if the features only come within a distance.
function whereOf(pair) {
  if (pair.relation) {
    const [from, to] = [pair.segment.slice(0, 3), pair.segment.slice(3)].map(end => `(${end.join(", ")})`);
    return isNaN(pair.segment[0]) ? "" : from === to ? `They meet in ${from}.` : `They meet from ${from} to ${to}.`;
  }
  if (!pair.weights.some(w => w > 0)) return "";
  const digits = x => String(Number(x.toPrecision(4)));
  const of = pair.elements.map((e, k) => e.map((v, i) => `${digits(pair.weights[k * FIRST[pair.kind] + i])} of ${v}`));
  return `Where ${of.map(e => e.join(" + ")).join(" meets ")}; normal (${pair.normal.map(digits).join(", ")}).`;
}

function queryOf(pair) {
  if (step.turns) {
    const at = positionsAt(step, pair.low);
    return pair.vertices.map(v => Array.from(at.subarray(3 * v, 3 * v + 3)).join(",")).join("\n") + "\n";
  }
  const row = (frame, v) => Array.from(frame.subarray(3 * v, 3 * v + 3)).join(",");
  return (pair.relation ? [step.before] : [step.before, step.after]).flatMap(frame => pair.vertices.map(v => row(frame, v))).join("\n") + "\n";
}

/// The time of first contact if it is known, else the time shown; the middle of the vertices and their radius.
function placeOfPair(pair) {
  const t = pair.relation ? 0 : step.timed ? pair.low : time();
  moveTo(t);
  const at = pair.vertices.map(v =>
    [0, 1, 2].map(a => scene.before[3 * v + a] * (1 - t) + scene.after[3 * v + a] * t));
  const middle = [0, 1, 2].map(a => at.reduce((sum, p) => sum + p[a], 0) / at.length);
  const radius = Math.max(...at.map(p => Math.hypot(...p.map((c, a) => c - middle[a]))));
  return {t, middle, radius: radius || .02};
}

function choose(i) {
  chosen = i;
  const pair = pairOf(step, i);
  element("detail").hidden = false;
  element("what").textContent = said(pair.elements);
  element("when").textContent = whenOf(pair);
  element("where").textContent = whereOf(pair);
  element("form").textContent = step.turns ? "Its vertices at that time, rounded (x,y,z):" : pair.relation ? "Its vertices (x,y,z):" : "As a query (x,y,z at t = 0, then at t = 1):";
  element("query").textContent = queryOf(pair);
  const {t, middle, radius} = placeOfPair(pair);
  if (picture) picture.choose(pair.elements, middle, radius);
  setTime(t);
  camera.look(middle, 2.5 * radius);
  reveal(order.indexOf(i));
  showRows();
  redraw();
}

function chooseNext(by) {
  const place = order.indexOf(chosen) + by;
  if (place >= 0 && place < order.length) choose(order[place]);
}

function chooseAt(x, y) {
  const {marks} = scene, t = time();
  let best = -1, nearest = 12;  // pixels
  for (let i = 0; i < step.count; ++i) {
    const at = [0, 1, 2].map(a => marks.before[3 * i + a] * (1 - t) + marks.after[3 * i + a] * t);
    const [right, below, depth] = camera.project(at), height = element("picture").clientHeight;
    const away = Math.hypot(right * height - x, below * height - y);
    if (depth > 0 && away < nearest) [best, nearest] = [i, away];
  }
  if (best >= 0) choose(best);
}

// Mouse, fingers, keys.

/// In pixels right of and below the middle of the picture.
function placeOf(event) {
  const box = element("picture").getBoundingClientRect();
  return [event.clientX - box.left - box.width / 2, event.clientY - box.top - box.height / 2];
}

function listenToPointers(canvas) {
  const down = new Map();
  let travelled = 0;
  const spread = () => {
    const [p, q] = [...down.values()];
    return {middle: [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2], width: Math.hypot(p[0] - q[0], p[1] - q[1])};
  };
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    if (down.size === 0) travelled = 0;
    down.set(event.pointerId, placeOf(event));
  });
  canvas.addEventListener("pointermove", event => {
    const before = down.get(event.pointerId), now = placeOf(event), height = canvas.clientHeight;
    if (!before) return;
    const [x, y] = [(now[0] - before[0]) / height, (now[1] - before[1]) / height];
    travelled += Math.hypot(x, y) * height;
    if (down.size === 1) {
      down.set(event.pointerId, now);
      if (event.buttons & 6 || event.shiftKey) camera.move(x, y); else camera.turn(x, y);
    } else if (down.size === 2) {
      const from = spread();
      down.set(event.pointerId, now);
      const to = spread();
      camera.move((to.middle[0] - from.middle[0]) / height, (to.middle[1] - from.middle[1]) / height);
      camera.zoom(from.width / Math.max(to.width, 1), to.middle[0] / height, to.middle[1] / height);
    }
    redraw();
  });
  canvas.addEventListener("pointerup", event => {
    if (down.delete(event.pointerId) && travelled < 4 && event.button === 0) chooseAt(...placeOf(event));
  });
  canvas.addEventListener("pointercancel", event => down.delete(event.pointerId));
  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 30 : 1;
    const [x, y] = placeOf(event).map(c => c / canvas.clientHeight);
    camera.zoom(Math.exp(.0015 * lines * event.deltaY), x, y);
    redraw();
  }, {passive: false});
}

function listenToControls() {
  element("time").oninput = () => setTime(time());
  for (const id of BOXES) element(id).onchange = redraw;
  element("up").onchange = () => {
    camera.up = element("up").selectedIndex;
    redraw();
  };
  element("whole").onclick = () => {
    camera.reset();
    redraw();
  };
  element("order").onchange = arrange;
  element("vertex").oninput = arrange;
  for (const id of ["controls", "choice"]) element(id).onsubmit = () => false;
  element("list").onscroll = showRows;
  element("copy").onclick = () => {
    getSelection().selectAllChildren(element("query"));
    document.execCommand("copy");
  };
  for (const id of ["list", "picture"])
    element(id).onkeydown = event => {
      const by = {ArrowDown: 1, ArrowUp: -1}[event.key];
      if (!by) return;
      event.preventDefault();
      chooseNext(by);
    };
}

function start() {
  const numbered = (n, word) => `${n.toLocaleString("en")} ${word}${n === 1 ? "" : "s"}`;
  const counted = step.kinds.map((kind, k) => k < STEP_KINDS
    ? `${kind.count.toLocaleString("en")} ${NAMES[k].replace("_", "/")}` : numbered(kind.count, "intersection") + " " + SHORT[k]);
  const met = step.count - step.pairs;
  element("count").textContent = [...(step.moves || step.pairs ? [numbered(step.pairs, "pair")] : []),
    ...(met || !step.moves ? [numbered(met, "intersection") + (step.moves ? " at the start" : "")] : [])].join(", ");
  element("kinds").textContent = counted.filter((_, k) => step.moves && k < 2 || step.kinds[k].count > 0).join(", ");
  element("slider").hidden = !step.moves;
  if (step.timed) element("order").add(new Option("by time", "time", true, true), 0);
  try {
    picture = new Picture(element("picture"), scene);
  } catch (error) {
    element("trouble").textContent = error.message;
    element("trouble").hidden = false;
  }
  listenToControls();
  listenToPointers(element("picture"));
  new ResizeObserver(() => {
    showRows();
    redraw();
  }).observe(document.body);
  new ResizeObserver(redraw).observe(element("picture"));
  arrange();
}

start();
