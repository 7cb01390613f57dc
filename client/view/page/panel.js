// ---- Peeling and pruning ----

let layers = [];  // geometries
function peel() {
  if (layers.length === 0) return redraw();
  const at = Math.min(Number(element("peel").value), layers.length - 1);
  const { shells } = data.layers[at];
  core.wrap(layers[at]);
  ghost.wrap(layers[0]);
  core.group.visible = element("show-object").checked;
  ghost.group.visible = core.group.visible && at > 0;
  core.uniforms.tint.value.setHex(labels ? 0 : at > 0 ? theme.core : theme.glass);
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
  for (const mesh of Object.values(nodes)) mesh.show();
  const { gone } = shown;
  element("prune-note").hidden = gone === 0;
  element("level").textContent = gone === 0 ? "all branches"
    : `${digits(gone)} off, to level ${figure(shown.threshold)}`;
  forget();
  if (coloring === colorings.branch) tubes.paint();
  showCounts();
  showPins();
  if (isOpen()) listRows();
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

function showParts() {
  const skeleton = element("show-skeleton").checked;
  tubes.mesh.visible = skeleton;
  if (sheets) sheets.visible = skeleton;
  for (const mesh of Object.values(nodes)) mesh.visible = element("show-nodes").checked;
  peel();
}

// ---- Facts ----

const kTopology = ["components", "loops", "cavities"];
function showCertificate() {
  const { mask, sampled, unprepared, input, skeleton } = result.certificate;
  const columns = [["image", mask], ["object", input], ["skeleton", skeleton]]
    .filter(([, topology]) => topology);
  element("certified").innerHTML = `<tr><th></th>${columns.map(([name]) =>
    `<th>${name}</th>`).join("")}</tr>`;
  element("certificate").innerHTML = kTopology.map((name) => `<tr><th>${name}</th>${columns.map(
    ([, topology]) => `<td>${digits(topology[name])}</td>`).join("")}</tr>`).join("");
  const kept = kTopology.every((name) => input[name] === skeleton[name]);
  const given = unprepared ?? input;
  const changes = (step, from, to) => {
    const changed = kTopology.filter((name) => from && from[name] !== to[name])
      .map((name) => `${name} ${digits(from[name])} \u2192 ${digits(to[name])}`);
    return changed.length > 0 ? [`${step} changed ${changed.join(", ")}`] : [];
  };
  const bySampling = changes("sampling", mask, given);
  const maybe = sampled && bySampling.length === 0 ? ["sampling may have changed the image's"] : [];
  const made = [...bySampling, ...changes("preparing", given, input), ...maybe].join("; ");
  element("verdict").className = kept && bySampling.length === 0 ? "" : "bad";
  element("verdict").textContent = !kept ? "\u2717 TOPOLOGY NOT KEPT"
    : made ? `topology kept by thinning; ${made}` : "\u2713 topology kept";
  const digest = String(result.sha256 ?? "");
  element("digest").textContent = digest && `sha256 ${digest.slice(0, 12)}\u2026`;
  element("digest").title = digest;
}

function showCounts() {
  element("counts").textContent = `${counted(shown.nodes.length, "node", "nodes")}, ` +
    `${counted(shown.branches.size, "branch", "branches")}, length ${measure(shown.length)}`;
  element("count-branches").textContent = digits(shown.branches.size);
  element("count-components").textContent = hidden.size === 0 ? digits(shown.parts.length)
    : `${digits(shown.parts.length - hidden.size)} of ${digits(shown.parts.length)}`;
}

function showLegend() {
  const css = (hex) => `#${new THREE.Color(hex).getHexString()}`;
  const { range, name } = coloring, bar = element("ramp");
  bar.hidden = tellsApart() || !(range.least <= range.most);
  bar.querySelector("i").style.background =
    `linear-gradient(to right, ${theme.ramp.map(css).join()})`;
  if (!bar.hidden) {
    element("least").textContent = `${name} ${figure(range.least)}`;
    element("most").textContent = `${figure(range.most)} ${coloring.unit ?? ""}`.trim();
  }
  for (const group of Object.keys(nodes)) {
    const dot = document.querySelector(`#legend .${group}`);
    dot.style.background = css(theme[group]);
    dot.parentElement.hidden = !result.nodes.some(
      ({ kind }) => groupOf(kind) === group && kind !== "loop");
  }
}

// ---- Colors ----

function paint(id) {
  if (colorings[id]) coloring = colorings[id];
  element("color").value = Object.keys(colorings).find((c) => colorings[c] === coloring);
  tubes.paint();
  if (sheets) sheets.paint();
  showLegend();
  redraw();
}

function dress(name) {
  root.dataset.theme = name;
  theme = themes[name];
  scene.background = new THREE.Color(theme.paper);
  for (const [group, mesh] of Object.entries(nodes)) mesh.material.color.setHex(theme[group]);
  for (const { material } of [hoverMark, pinMark]) material.color.setHex(theme.mark);
  cutFrame.material.color.setHex(theme.mark);
  paint();
  peel();
}

const systemDark = window.matchMedia("(prefers-color-scheme: dark)");
const systemTheme = () => systemDark.matches ? "dark" : "light";
let flipped = false;  // by the user
function flip() {
  flipped = true;
  dress(theme === themes.dark ? "light" : "dark");
}

// ---- Keys ----

function toggleSide() {
  const open = element("app").classList.toggle("bare");
  element("menu").setAttribute("aria-expanded", !open);
}
const axisKey = (axis) => (event) => lookAlong(axis, event.shiftKey ? -1 : 1);
const keys = {
  r: reset, t: flip, " ": play, o: () => setFlat(!view.flat), b: () => openDock(!isOpen()),
  m: toggleSide, l: copyLink, x: axisKey(0), y: axisKey(1), z: axisKey(2),
  arrowleft: () => orbit(-0.12, 0), arrowright: () => orbit(0.12, 0),
  arrowup: () => orbit(0, 0.12), arrowdown: () => orbit(0, -0.12),
  "+": () => orbit(0, 0, 0.88), "=": () => orbit(0, 0, 0.88), "-": () => orbit(0, 0, 1 / 0.88),
  "]": () => step("peel", 1), "[": () => step("peel", -1),
  ".": () => step("prune", 1), ",": () => step("prune", -1),
  "/": () => {
    openDock(true);
    element("search").focus();
  },
  escape: () => {
    forget();
    setPins([]);
  },
};
function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const writes = event.target.matches("input, select");
  if (event.key === "Escape" && writes) return event.target.blur();
  const presses = event.target.matches("button, summary") && [" ", "Enter"].includes(event.key);
  if (writes || presses) return;
  const act = keys[event.key.toLowerCase()];
  if (!act) return;
  event.preventDefault();
  act(event);
}

// ---- Beginning ----

function listen() {
  const on = (id, type, act) => element(id).addEventListener(type, act);
  new ResizeObserver(redraw).observe(stage);
  window.addEventListener("keydown", onKey);
  window.addEventListener("hashchange", () => grant(wished()));
  systemDark.addEventListener("change", () => { if (!flipped) dress(systemTheme()); });
  for (const id of ["peel", "strength"]) on(id, "input", peel);
  for (const name of ["object", "skeleton", "nodes"]) on(`show-${name}`, "input", showParts);
  on("prune", "input", prune);
  on("color", "input", (event) => paint(event.target.value));
  for (const [id, act] of Object.entries(
    { play, reset, theme: flip, menu: toggleSide, "save-csv": saveCsv, "copy-link": copyLink,
      unpin: () => setPins([]), flat: () => setFlat(!view.flat), "save-1x": () => savePicture(1),
      "save-2x": () => savePicture(2) })) {
    on(id, "click", act);
  }
  for (const button of document.querySelectorAll("[data-look]")) {
    const [sign, name] = button.dataset.look;
    button.addEventListener("click", () => lookAlong(axisNumber(name), sign === "+" ? 1 : -1));
  }
  on("pinned", "click", ({ target }) => {
    const branch = branchWith(Number(target.closest("tr")?.dataset.branch));
    if (branch && target.matches(".go")) center(branch);
    if (branch && target.matches(".off")) togglePin(branch);
  });
  listenToPointers();
  listenToCut();
  listenToTable();
}

function showPanels() {
  document.title = element("title").textContent = data.title;
  const world = result.world !== "unknown" && result.world;
  element("points").textContent = [
    labels && counted(labels.names.length, "label", "labels"),
    counted(result.object_points, "point", "points"), world, unit].filter(Boolean).join(" \u00b7 ");
  element("tab-components").firstChild.textContent = `${kPart}s `;
  for (const [id, { name }] of Object.entries(colorings)) {
    element("color").append(new Option(name, id));
  }
  for (const head of document.querySelectorAll("#pins [data-unit]")) {
    head.textContent = inUnit(head.textContent);
  }
  for (const part of document.querySelectorAll(".of-object")) part.hidden = !data.layers.length;
  if (labels) {
    for (const part of [element("peel").closest("section"),
                        document.querySelector("#keys .of-object")]) part.hidden = true;
  }
  element("pruning").hidden = levels.length === 0;
  element("prune").max = levels.length;
  element("save-1x").disabled = element("save-2x").disabled = renderer === null;
  if (window.innerWidth <= 760) toggleSide();  // as in style.css
  showCertificate();
}

function boxOfAll() {
  const box = layers.length ? layers[0].boundingBox.clone() : new THREE.Box3();
  if (!layers.length) box.setFromArray(curvePoints);
  if (sheets) box.union(sheets.geometry.boundingBox);
  if (box.isEmpty()) {
    for (const [n, { radius }] of result.nodes.entries()) {
      const place = new THREE.Vector3().fromArray(nodePlaces, 3 * n);
      box.union(new THREE.Sphere(place, radius / edge).getBoundingBox(new THREE.Box3()));
    }
  }
  return box.isEmpty() ? box.expandByPoint(new THREE.Vector3(0.5, 0.5, 0.5)) : box;
}

async function start() {
  showPanels();
  if (data.sheets.triangles > 0) {
    sheets = await sheetMesh();
    scene.add(sheets);
  }
  if (data.layers.length) layers = [await surfaceGeometry(data.layers[0])];
  const box = boxOfAll();
  prepareCut(box);
  wholeBox.copy(box);
  Object.assign(view, wholeView());
  dress(systemTheme());
  prune();
  listen();
  for (const layer of data.layers.slice(1)) layers.push(await surfaceGeometry(layer));
  element("peel").max = Math.max(0, data.layers.length - 1);
  element("peel").disabled = data.layers.length < 2;
  element("prune").disabled = levels.length === 0;
  grant(wished());
  draw();  // immediately: code that waits for the state expects the picture
  root.dataset.state = "ready";
}
start();
