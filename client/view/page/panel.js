// ---- Peeling and pruning ----

let layers = [];  // geometries
let sheets = null;  // a mesh, where the skeleton has any
function peel() {
  if (layers.length === 0) return redraw();
  const at = Math.min(Number(element("peel").value), layers.length - 1);
  const { shells } = data.layers[at];
  core.wrap(layers[at]);
  ghost.wrap(layers[0]);
  core.group.visible = element("show-object").checked;
  ghost.group.visible = core.group.visible && at > 0;
  core.uniforms.tint.value.setHex(at > 0 ? theme.core : theme.glass);
  const strength = Number(element("strength").value);
  core.uniforms.strength.value = 1.6 * strength;
  ghost.uniforms.tint.value.setHex(theme.glass);
  ghost.uniforms.strength.value = (theme === themes.dark ? 1 : 0.5) * strength;
  element("shells").textContent =
    shells === 0 ? "whole object" : `${shells} of ${data.last_shell} shells off`;
  redraw();
}

function prune() {
  shown = prunedTo(Number(element("prune").value));
  tubes.show(shown.edges);
  for (const mesh of Object.values(nodes)) mesh.show(shown.nodes);
  const gone = result.edges.length - shown.edges;
  element("level").textContent = gone === 0 ? "all branches"
    : `${digits(gone)} off, to level ${figure(levels[shown.step - 1])}`;
  forget();
  if (coloring === colorings.branch) colorTubes(tubes);
  showCounts();
  redraw();
}

function step(id, by) {
  const slider = element(id);
  if (slider.disabled) return;
  slider.value = Number(slider.value) + by;
  slider.dispatchEvent(new Event("input"));
}

let playing = 0;
function play() {
  if (element("peel").disabled) return;
  const slider = element("peel");
  clearInterval(playing);
  element("play").textContent = playing ? "\u25b6" : "\u23f8";
  playing = playing ? 0 : setInterval(() => {
    slider.value = (Number(slider.value) + 1) % data.layers.length;
    peel();
  }, 350);
}

// ---- Figures under the pointer ----

const figure = (v) => Number(v.toPrecision(4)).toString();
const measure = (v) => `${figure(v)} ${unit}`.trim();
const digits = (n) => n.toLocaleString("en-US");
const escaped = (text) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const words = (kind) => escaped(kind.replace("_", " "));

// What calls visit(scene point, ...rest) gives nearest to the pointer on the screen, if that is
// within `reach` pixels.
function nearest(x, y, reach, forEach) {
  const project = new THREE.Matrix4().multiplyMatrices(
    camera.projectionMatrix, camera.matrixWorldInverse).elements;
  let best = null;
  forEach((p, ...rest) => {
    const along = (row) => project[row] * p[0] + project[row + 4] * p[1] +
      project[row + 8] * p[2] + project[row + 12];
    const w = along(3), u = (along(0) / w + 1) / 2 * window.innerWidth;
    const distance = Math.hypot(u - x, (1 - along(1) / w) / 2 * window.innerHeight - y);
    if (distance >= reach) return;
    reach = distance;
    best = rest;
  });
  return best;
}

function nodeUnder(x, y) {
  if (!nodes.end.visible) return null;
  const found = nearest(x, y, 9, (visit) => {
    for (const n of shown.nodes) {
      if (isDrawn(result.nodes[n])) visit(toScene(result.nodes[n].position), n);
    }
  });
  if (!found) return null;
  const node = result.nodes[found[0]];
  const rows = [["radius", measure(node.radius)],
                ["at", node.position.map(figure).join(", ")]];
  if (shown.degree[found[0]]) rows.unshift(["branches", shown.degree[found[0]]]);
  if (node.cavities) rows.push(["cavities", node.cavities]);
  return { title: `${words(node.kind)} ${found[0]}`, rows, place: toScene(node.position),
           radius: node.radius };
}

function branchUnder(x, y) {
  if (!tubes.visible) return null;
  const found = nearest(x, y, 14, (visit) => {
    for (const id of byLevel.slice(0, shown.edges)) {
      curves[id].forEach((p, n) => visit(p, id, n));
    }
  });
  if (!found) return null;
  const [id, n] = found, e = result.edges[id], first = shown.branchOf(id);
  const branch = shown.branches.get(first), whole = branch.edges.length === 1;
  const { least, most } = rangeOf(branch.edges.flatMap((part) => result.edges[part].radii));
  const ends = branch.ends.map((row) => words(result.nodes[row].kind));
  const rows = [["length", measure(branch.length)],
                ["radius here", `${measure(e.radii[n])} (${figure(least)} to ${figure(most)})`]];
  if (whole && e.tortuosity !== undefined) rows.push(["tortuosity", figure(e.tortuosity)]);
  for (const { name, ofEdge } of Object.values(colorings)) {
    if (!ofEdge || name === "length") continue;
    rows.push([name, Number.isFinite(ofEdge(e)) ? figure(ofEdge(e)) : "stays"]);
  }
  return { title: `branch ${first}`, detail: ends.join(" to ") || "loop", rows, place: curves[id][n],
           radius: e.radii[n] };
}

function forget() {
  element("tip").hidden = true;
  marker.visible = false;
}

function tellAt(x, y) {
  const tip = element("tip");
  const found = nodeUnder(x, y) || branchUnder(x, y);
  if (tip.hidden && !found) return;
  forget();
  if (found) {
    tip.hidden = false;
    tip.innerHTML = `<b>${found.title}</b> ${found.detail || ""}<table>${found.rows.map(
      ([name, value]) => `<tr><th>${name}</th><td>${value}</td></tr>`).join("")}</table>`;
    const within = (at, size, room) => Math.max(8, Math.min(at + 24, room - size - 8));
    tip.style.left = `${within(x, tip.offsetWidth, window.innerWidth)}px`;
    tip.style.top = `${within(y, tip.offsetHeight, window.innerHeight)}px`;
    marker.visible = true;
    marker.position.set(...found.place);
    marker.scale.setScalar(Math.max(found.radius / edge, 1e-6));
    marker.material.color.copy(rampColor(found.radius, colorings.radius.range));
  }
  redraw();
}

// A finger has no place to hover: a tap tells instead.
let pressed = null;
function onPointer(event) {
  if (event.type === "pointerdown") pressed = event;
  if (event.type === "pointermove" && event.buttons === 0 && event.pointerType !== "touch") {
    tellAt(event.clientX, event.clientY);
  }
  if (event.type !== "pointerup" || event.pointerType !== "touch" || !pressed) return;
  const way = Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY);
  if (way < 10) tellAt(event.clientX, event.clientY);
}

// ---- The page around ----

const kTopology = ["components", "loops", "cavities"];
function showCertificate() {
  const { mask, sampled, input, skeleton } = result.certificate;
  const columns = [["image", mask], ["object", input], ["skeleton", skeleton]]
    .filter(([, topology]) => topology);
  element("certified").innerHTML = `<tr><th></th>${columns.map(([name]) =>
    `<th>${name}</th>`).join("")}</tr>`;
  element("certificate").innerHTML = kTopology.map((name) => `<tr><th>${name}</th>${columns.map(
    ([, topology]) => `<td>${digits(topology[name])}</td>`).join("")}</tr>`).join("");
  const kept = kTopology.every((name) => input[name] === skeleton[name]);
  element("verdict").className = kept ? "" : "bad";
  element("verdict").textContent = !kept ? "\u2717 TOPOLOGY NOT KEPT"
    : sampled ? "\u2713 kept from the sampled object on; sampling may have changed the image's"
      : "\u2713 topology kept";
  element("digest").textContent = `sha256 ${result.sha256.slice(0, 12)}\u2026`;
  element("digest").title = result.sha256;
}

function showCounts() {
  const count = (n, one, many) => `${digits(n)} ${n === 1 ? one : many}`;
  element("counts").textContent = `${count(shown.nodes.length, "node", "nodes")}, ` +
    `${count(shown.branches.size, "branch", "branches")}, length ${measure(shown.length)}`;
}

function showLegend() {
  const css = (hex) => `#${new THREE.Color(hex).getHexString()}`;
  const { range, name } = coloring, bar = element("ramp");
  bar.hidden = coloring === colorings.branch || !(range.least <= range.most);
  bar.querySelector("i").style.background =
    `linear-gradient(to right, ${theme.ramp.map(css).join()})`;
  if (!bar.hidden) {
    element("least").textContent = `${name} ${figure(range.least)}`;
    element("most").textContent = figure(range.most);
  }
  for (const group of Object.keys(nodes)) {
    document.querySelector(`#legend .${group}`).style.background = css(theme[group]);
    const there = result.nodes.some((n) => groupOf(n.kind) === group && isDrawn(n));
    document.querySelector(`#legend .${group}`).parentElement.hidden = !there;
  }
}

function paint(id) {
  if (colorings[id]) coloring = colorings[id];
  element("color").value = Object.keys(colorings).find((c) => colorings[c] === coloring);
  colorTubes(tubes);
  if (sheets) sheets.paint();
  showLegend();
  redraw();
}

function dress(name) {
  root.dataset.theme = name;
  theme = themes[name];
  scene.background = new THREE.Color(theme.paper);
  for (const [group, mesh] of Object.entries(nodes)) mesh.material.color.setHex(theme[group]);
  paint();
  peel();
}

function flip() { dress(theme === themes.dark ? "light" : "dark"); }
function reset() {
  controls.reset();
  redraw();
}

const keys = {
  r: reset, t: flip, " ": play,
  arrowleft: () => moveCamera(-0.12, 0, 1), arrowright: () => moveCamera(0.12, 0, 1),
  arrowup: () => moveCamera(0, 0.12, 1), arrowdown: () => moveCamera(0, -0.12, 1),
  "+": () => moveCamera(0, 0, 0.88), "-": () => moveCamera(0, 0, 1 / 0.88),
  "]": () => step("peel", 1), "[": () => step("peel", -1),
  ".": () => step("prune", 1), ",": () => step("prune", -1),
  escape: () => { forget(); redraw(); },
};
function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.target.matches("input, select, button, summary")) return;
  const act = keys[event.key.toLowerCase()];
  if (!act) return;
  event.preventDefault();
  act();
}

function listen() {
  const onInput = (id, act) => element(id).addEventListener("input", act);
  controls.addEventListener("change", redraw);
  window.addEventListener("resize", redraw);
  for (const type of ["pointerdown", "pointermove", "pointerup"]) {
    canvas.addEventListener(type, onPointer);
  }
  for (const id of ["peel", "strength", "show-object"]) onInput(id, peel);
  onInput("prune", prune);
  onInput("show-skeleton", (e) => {
    tubes.visible = e.target.checked;
    if (sheets) sheets.visible = e.target.checked;
    redraw();
  });
  onInput("show-nodes", (e) => {
    for (const mesh of Object.values(nodes)) mesh.visible = e.target.checked;
    redraw();
  });
  onInput("color", (e) => paint(e.target.value));
  element("play").addEventListener("click", play);
  element("reset").addEventListener("click", reset);
  element("theme").addEventListener("click", flip);
  window.addEventListener("keydown", onKey);
}

function showPanels() {
  document.title = element("title").textContent = data.title;
  element("points").textContent = `${digits(result.object_points)} points`;
  for (const [id, { name }] of Object.entries(colorings)) {
    element("color").append(new Option(`by ${name}`, id));
  }
  for (const part of document.querySelectorAll(".of-object")) part.hidden = !data.layers.length;
  element("pruning").hidden = levels.length === 0;
  element("sliders").hidden = levels.length === 0 && data.layers.length === 0;
  element("prune").max = levels.length;
  if (window.innerWidth < 720) {
    for (const card of document.querySelectorAll("details")) card.open = false;
  }
  showCertificate();
}

// What to show first may be said in the address, such as #peel=5&prune=3&theme=dark&color=branch.
function grant(wish) {
  if (wish.has("peel")) element("peel").value = wish.get("peel");
  if (wish.has("prune")) element("prune").value = wish.get("prune");
  if (themes[wish.get("theme")]) dress(wish.get("theme"));
  if (wish.has("color")) paint(wish.get("color"));
}

async function start() {
  showPanels();
  if (data.sheets.triangles > 0) {
    sheets = await sheetMesh();
    scene.add(sheets);
  }
  dress(window.matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  if (data.layers.length) layers = [await surfaceGeometry(data.layers[0])];
  tubes.geometry.computeBoundingBox();
  const whole = layers.length ? layers[0].boundingBox : tubes.geometry.boundingBox.clone();
  if (sheets) whole.union(sheets.geometry.boundingBox);
  if (whole.isEmpty()) whole.expandByPoint(new THREE.Vector3(0.5, 0.5, 0.5));
  startView(whole);
  prune();
  peel();
  listen();
  for (const layer of data.layers.slice(1)) layers.push(await surfaceGeometry(layer));
  element("peel").max = Math.max(0, data.layers.length - 1);
  element("peel").disabled = data.layers.length < 2;
  element("prune").disabled = levels.length === 0;
  grant(new URLSearchParams(location.hash.slice(1)));
  peel();
  prune();
  draw();  // at once: whoever waits for the state finds the picture
  root.dataset.state = "ready";
}
start();
