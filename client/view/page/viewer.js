"use strict";

// Shows what the two JSON elements hold: `data` the surfaces, packed by packed_numbers.h, and
// `result` the skeleton, as client/export/skeleton.schema.json says.

const data = JSON.parse(document.getElementById("data").textContent);
const result = JSON.parse(document.getElementById("result").textContent);
const root = document.documentElement;
const element = (id) => document.getElementById(id);
window.addEventListener("error", () => { root.dataset.state = "failed"; });
window.addEventListener("unhandledrejection", () => { root.dataset.state = "failed"; });

// ---- Data ----

async function unpack(text, count) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const inflated = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const packed = new Uint8Array(await new Response(inflated).arrayBuffer());
  const numbers = new Uint32Array(count);
  for (let n = 0, at = 0, value = 0; n < count; ++n) {
    let zigzag = 0, unit = 1, byte;
    do {
      byte = packed[at++];
      zigzag += (byte & 127) * unit;
      unit *= 128;
    } while (byte & 128);
    numbers[n] = value += zigzag % 2 ? -(zigzag + 1) / 2 : zigzag / 2;
  }
  return numbers;
}

// The scene is the world, moved and scaled so that the object's cube has edges of 1.
const edge = 65535 * data.step;
const toScene = (p) => p.map((v, axis) => (v - data.low[axis]) / edge);

async function surfaceGeometry(layer) {
  const [steps, corners] = await Promise.all(
    [unpack(layer.coordinates, 3 * layer.vertices), unpack(layer.corners, 3 * layer.triangles)]);
  const positions = new Float32Array(3 * layer.vertices);
  for (let n = 0; n < positions.length; ++n) {
    positions[n] = steps[(n % 3) * layer.vertices + (n - n % 3) / 3] / 65535;
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setIndex(new THREE.BufferAttribute(corners, 1));
  geometry.computeVertexNormals();
  geometry.computeBoundingBox();
  return geometry;
}

// ---- Colors ----

const themes = {
  light: { paper: 0xf6f8fb, glass: 0x7698c4, core: 0xd08a4e, end: 0x10b981, junction: 0x1f2937,
           other: 0x0284c7, lightness: 0.42,
           radii: [0x2e1065, 0x7c1d82, 0xc42d60, 0xeb5e28, 0xf59e0b] },
  dark: { paper: 0x10151f, glass: 0x7fa8dd, core: 0xe0a06a, end: 0x34d399, junction: 0xcbd5e1,
          other: 0x38bdf8, lightness: 0.62,
          radii: [0x7c6cff, 0xb95cf0, 0xff5f9e, 0xff9a57, 0xffe28a] },
};
let theme = themes.light;

const allRadii = result.nodes.map((n) => n.radius).concat(...result.edges.map((e) => e.radii));
const least = allRadii.reduce((a, b) => Math.min(a, b), Infinity);
const most = allRadii.reduce((a, b) => Math.max(a, b), -Infinity);

function radiusColor(radius) {
  const part = most > least ? (radius - least) / (most - least) : 0.5;
  const place = part * (theme.radii.length - 1);
  const stop = Math.min(Math.floor(place), theme.radii.length - 2);
  return new THREE.Color(theme.radii[stop])
    .lerp(new THREE.Color(theme.radii[stop + 1]), place - stop);
}
// Neighboring numbers get hues far apart.
const branchColor = (id) =>
  new THREE.Color().setHSL((id * 0.618034) % 1, 0.68, theme.lightness);

// ---- Skeleton ----

// The steps of the lattice are smoothed away between the ends, for the eye only.
function smoothed(points) {
  let curve = points.map(toScene);
  for (let turn = 0; turn < 6; ++turn) {
    curve = curve.map((p, n) => n === 0 || n === curve.length - 1 ? p :
      p.map((v, axis) => (curve[n - 1][axis] + 2 * v + curve[n + 1][axis]) / 4));
  }
  return curve;
}
const curves = result.edges.map((e) => smoothed(e.points));
const pointCount = curves.reduce((sum, c) => sum + c.length, 0);
const kThickness = 0.0038;
const kSides = pointCount > 100000 ? 4 : 8;

// Rings around every point, turned no more than the curve turns.
function addTube(curve, positions, normals, corners) {
  const at = curve.map((p) => new THREE.Vector3(...p));
  const tangent = (n) => new THREE.Vector3().subVectors(
    at[Math.min(n + 1, at.length - 1)], at[Math.max(n - 1, 0)]).normalize();
  let side = new THREE.Vector3(0.36, 0.48, 0.8);
  for (let n = 0; n < at.length; ++n) {
    const along = tangent(n), first = positions.length / 3;
    side = side.sub(along.clone().multiplyScalar(side.dot(along)));
    if (side.lengthSq() < 1e-8) side = new THREE.Vector3(along.y, along.z, -along.x).cross(along);
    side.normalize();
    const other = new THREE.Vector3().crossVectors(along, side);
    for (let k = 0; k < kSides; ++k) {
      const angle = 2 * Math.PI * k / kSides, c = Math.cos(angle), s = Math.sin(angle);
      const out = side.clone().multiplyScalar(c).addScaledVector(other, s);
      normals.push(out.x, out.y, out.z);
      const p = at[n].clone().addScaledVector(out, kThickness);
      positions.push(p.x, p.y, p.z);
      if (n === 0) continue;
      const next = (k + 1) % kSides, a = first + k, b = first + next;
      corners.push(a - kSides, b - kSides, b, a - kSides, b, a);
    }
  }
}

function tubeMesh() {
  const positions = [], normals = [], corners = [];
  for (const curve of curves) addTube(curve, positions, normals, corners);
  const geometry = new THREE.BufferGeometry();
  const attribute = (list) => new THREE.BufferAttribute(new Float32Array(list), 3);
  geometry.setAttribute("position", attribute(positions));
  geometry.setAttribute("normal", attribute(normals));
  geometry.setAttribute("color",
    new THREE.BufferAttribute(new Float32Array(positions.length), 3));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(corners), 1));
  return new THREE.Mesh(geometry, new THREE.MeshPhongMaterial(
    { vertexColors: THREE.VertexColors, shininess: 60, specular: 0x222222 }));
}

function colorTubes(mesh) {
  const colors = mesh.geometry.attributes.color;
  let at = 0;
  result.edges.forEach((e, id) => {
    const ofBranch = branchColor(id);
    for (const radius of e.radii) {
      const { r, g, b } = element("color").value === "branch" ? ofBranch : radiusColor(radius);
      for (let k = 0; k < kSides; ++k) colors.setXYZ(at++, r, g, b);
    }
  });
  colors.needsUpdate = true;
}

const groupOf = (kind) => kind === "end" || kind === "junction" ? kind : "other";
function nodeMeshes() {
  const meshes = {};
  for (const group of ["end", "junction", "other"]) {
    // A loop's node only stands for its curve.
    const nodes = result.nodes.filter((n) => groupOf(n.kind) === group && n.kind !== "loop");
    const mesh = new THREE.InstancedMesh(new THREE.SphereBufferGeometry(2.1 * kThickness, 16, 12),
      new THREE.MeshPhongMaterial({ shininess: 60, specular: 0x333333 }), nodes.length);
    nodes.forEach((n, at) => mesh.setMatrixAt(
      at, new THREE.Matrix4().makeTranslation(...toScene(n.position))));
    mesh.frustumCulled = false;
    meshes[group] = mesh;
  }
  return meshes;
}

// ---- Glass ----

// Faint where the surface faces the viewer, dense toward its outlines, under a lamp from the upper
// left.
const glassVertex = `
varying vec3 v_normal; varying vec3 v_view;
void main() {
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  v_normal = normalMatrix * normal;
  v_view = -at.xyz;
  gl_Position = projectionMatrix * at;
}`;
const glassFragment = `
uniform vec3 tint; uniform float strength; uniform float body;
varying vec3 v_normal; varying vec3 v_view;
void main() {
  vec3 n = normalize(v_normal), v = normalize(v_view), lamp = vec3(-0.45, 0.65, 0.61);
  if (dot(n, v) < 0.0) n = -n;
  float rim = 1.0 - dot(n, v), light = max(0.0, dot(n, lamp));
  float gleam = pow(max(0.0, dot(reflect(-lamp, n), v)), 30.0);
  vec3 color = tint * (0.68 + 0.42 * light - 0.22 * rim) + 0.28 * gleam;
  float cover = body * (0.30 + 0.22 * (1.0 - light)) + 1.1 * pow(rim, 1.7) + 0.2 * gleam;
  gl_FragColor = vec4(color, clamp(strength * cover, 0.0, 1.0));
}`;

// First the depth, then the color of what is in front: one layer of glass, not four.
class Glass {
  constructor(order, body) {
    this.depth = new THREE.Mesh(undefined, new THREE.MeshBasicMaterial(
      { colorWrite: false, transparent: true }));
    this.uniforms = { tint: { value: new THREE.Color() }, strength: { value: 1 },
                      body: { value: body } };
    this.color = new THREE.Mesh(undefined, new THREE.ShaderMaterial(
      { uniforms: this.uniforms, vertexShader: glassVertex, fragmentShader: glassFragment,
        transparent: true, depthWrite: false }));
    this.depth.renderOrder = order;
    this.color.renderOrder = order + 1;
    this.group = new THREE.Group().add(this.depth, this.color);
  }
  wrap(geometry) { this.depth.geometry = this.color.geometry = geometry; }
}

// ---- The scene ----

const canvas = element("scene");
const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
const scene = new THREE.Scene();
const camera = new THREE.PerspectiveCamera(32, 1, 0.01, 50);
const controls = new THREE.OrbitControls(camera, canvas);
const lamp = new THREE.DirectionalLight(0xffffff, 0.75);
lamp.position.set(-0.45, 0.65, 0.61);
camera.add(lamp);
scene.add(camera, new THREE.AmbientLight(0xffffff, 0.5));

const core = new Glass(1, 1), ghost = new Glass(3, 0);
ghost.depth.visible = false;
const tubes = tubeMesh(), nodes = nodeMeshes();
const marker = new THREE.Mesh(new THREE.SphereBufferGeometry(1, 40, 28), new THREE.MeshPhongMaterial(
  { transparent: true, opacity: 0.35, depthWrite: false }));
marker.visible = false;
marker.renderOrder = 0.5;  // behind the glass, before its depth
scene.add(core.group, ghost.group, tubes, ...Object.values(nodes), marker);

let asked = false;
function redraw() {
  if (!asked) requestAnimationFrame(draw);
  asked = true;
}
function draw() {
  asked = false;
  const width = window.innerWidth, height = window.innerHeight;
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
  renderer.setSize(width, height, false);
  camera.aspect = width / height;
  camera.updateProjectionMatrix();
  renderer.render(scene, camera);
  drawAxes();
}

// A three-quarter view on the broadest side; up is +y, or +z when y is the thinnest axis.
function startView(box) {
  const size = box.getSize(new THREE.Vector3()), center = box.getCenter(new THREE.Vector3());
  let toward = new THREE.Vector3(0, 0, 1), up = new THREE.Vector3(0, 1, 0);
  if (size.z > size.x || size.z > size.y) {
    if (size.x <= size.y) {
      toward.set(1, 0, 0);
    } else {
      toward.set(0, -1, 0);
      up.set(0, 0, 1);
    }
  }
  const right = new THREE.Vector3().crossVectors(up, toward);
  const from = toward.multiplyScalar(0.84).addScaledVector(right, 0.48).addScaledVector(up, 0.26);
  const aspect = Math.min(1, window.innerWidth / window.innerHeight);
  camera.up.copy(up);
  camera.position.copy(center).addScaledVector(from.normalize(), 1.55 * size.length() / aspect);
  controls.target.copy(center);
  controls.update();
  controls.saveState();
}

function drawAxes() {
  const pen = element("axes").getContext("2d"), middle = 80, reach = 56;
  pen.clearRect(0, 0, 160, 160);
  pen.lineWidth = 3;
  pen.lineCap = "round";
  pen.font = "22px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  const turn = camera.quaternion.clone().inverse();
  const axes = [["x", "#e11d48", 1, 0, 0], ["y", "#16a34a", 0, 1, 0], ["z", "#3b82f6", 0, 0, 1]]
    .map(([name, color, ...v]) => ({ name, color, v: new THREE.Vector3(...v).applyQuaternion(turn) }));
  for (const { name, color, v } of axes.sort((a, b) => a.v.z - b.v.z)) {
    pen.strokeStyle = pen.fillStyle = color;
    pen.beginPath();
    pen.moveTo(middle, middle);
    pen.lineTo(middle + reach * v.x, middle - reach * v.y);
    pen.stroke();
    pen.fillText(name, middle + 1.25 * reach * v.x, middle - 1.25 * reach * v.y);
  }
}

// ---- Peeling ----

let layers = [];  // geometries
function peel() {
  const at = Number(element("peel").value), { shells } = data.layers[at];
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

let playing = 0;
function play() {
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
const escaped = (text) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);

// The skeleton's point nearest to the pointer on the screen, if one is near.
function pointUnder(x, y) {
  const project = new THREE.Matrix4().multiplyMatrices(
    camera.projectionMatrix, camera.matrixWorldInverse).elements;
  let best = { distance: 14 };
  curves.forEach((curve, id) => curve.forEach((p, n) => {
    const along = (row) => project[row] * p[0] + project[row + 4] * p[1] +
      project[row + 8] * p[2] + project[row + 12];
    const w = along(3), u = (along(0) / w + 1) / 2 * window.innerWidth;
    const distance = Math.hypot(u - x, (1 - along(1) / w) / 2 * window.innerHeight - y);
    if (distance < best.distance) best = { distance, id, n };
  }));
  return best.id === undefined ? null : best;
}

function tell(event) {
  const tip = element("tip");
  const found = event.buttons === 0 && tubes.visible ? pointUnder(event.clientX, event.clientY)
    : null;
  if (tip.hidden && !found) return;
  tip.hidden = !found;
  marker.visible = Boolean(found);
  if (found) {
    const branch = result.edges[found.id], radius = branch.radii[found.n];
    const ends = [branch.source, branch.target].map((n) => result.nodes[n].kind.replace("_", " "));
    tip.innerHTML = `<b>branch ${found.id}</b>: ${escaped(ends.join(" to "))}
length <b>${figure(branch.length)}</b>
radius here <b>${figure(radius)}</b> (${figure(Math.min(...branch.radii))} to ${
  figure(Math.max(...branch.radii))})`;
    tip.style.left = `${Math.min(event.clientX + 28, window.innerWidth - tip.offsetWidth - 8)}px`;
    tip.style.top = `${Math.min(event.clientY + 28, window.innerHeight - tip.offsetHeight - 8)}px`;
    marker.position.set(...curves[found.id][found.n]);
    marker.scale.setScalar(Math.max(radius / edge, 1e-6));
    marker.material.color.copy(radiusColor(radius));
  }
  redraw();
}

// ---- The page around ----

function showFacts() {
  const { input, skeleton, simple_points_left: simple } = result.certificate;
  const digits = (n) => n.toLocaleString("en-US");
  document.title = element("title").textContent = data.title;
  element("points").textContent = `${digits(result.object_points)} points`;
  const rows = ["components", "loops", "cavities"].map((n) => [n, input[n], skeleton[n]]);
  element("certificate").innerHTML = rows.map(([name, a, b]) => `<tr><th>${name}</th><td>${
    digits(a)}</td><td>${digits(b)}</td></tr>`).join("");
  const kept = ["components", "loops", "cavities"].every((name) => input[name] === skeleton[name]);
  element("verdict").className = kept ? "" : "bad";
  element("verdict").textContent = kept ? "\u2713 topology kept" : "\u2717 TOPOLOGY NOT KEPT";
  const note = document.createElement("small");
  note.textContent = `${digits(result.nodes.length)} nodes, ${digits(result.edges.length)} ` +
    `branches, ${digits(simple)} simple points left`;
  element("verdict").append(note);
}

function showLegend() {
  const css = (hex) => `#${new THREE.Color(hex).getHexString()}`;
  const bar = element("radii");
  bar.style.visibility = element("color").value === "radius" && allRadii.length ? "" : "hidden";
  bar.querySelector("i").style.background =
    `linear-gradient(to right, ${theme.radii.map(css).join()})`;
  if (allRadii.length) {
    element("least").textContent = `radius ${figure(least)}`;
    element("most").textContent = figure(most);
  }
  for (const group of Object.keys(nodes)) {
    document.querySelector(`#legend .${group}`).style.background = css(theme[group]);
  }
}

function dress(name) {
  root.dataset.theme = name;
  theme = themes[name];
  scene.background = new THREE.Color(theme.paper);
  for (const [group, mesh] of Object.entries(nodes)) mesh.material.color.setHex(theme[group]);
  colorTubes(tubes);
  showLegend();
  if (layers.length) peel();
}

function listen() {
  const flip = () => dress(theme === themes.dark ? "light" : "dark");
  const reset = () => { controls.reset(); redraw(); };
  const onInput = (id, act) => element(id).addEventListener("input", act);
  controls.addEventListener("change", redraw);
  window.addEventListener("resize", redraw);
  canvas.addEventListener("pointermove", tell);
  for (const id of ["peel", "strength", "show-object"]) onInput(id, peel);
  onInput("show-skeleton", (e) => { tubes.visible = e.target.checked; redraw(); });
  onInput("show-nodes", (e) => {
    for (const mesh of Object.values(nodes)) mesh.visible = e.target.checked;
    redraw();
  });
  onInput("color", () => { colorTubes(tubes); showLegend(); redraw(); });
  element("play").addEventListener("click", play);
  element("reset").addEventListener("click", reset);
  element("theme").addEventListener("click", flip);
  window.addEventListener("keydown", (e) => {
    if (e.target.matches("input, select, button")) return;
    const act = { r: reset, t: flip, " ": play }[e.key.toLowerCase()];
    if (act) act();
  });
}

async function start() {
  showFacts();
  dress(window.matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  layers = [await surfaceGeometry(data.layers[0])];
  startView(layers[0].boundingBox);
  peel();
  listen();
  for (const layer of data.layers.slice(1)) layers.push(await surfaceGeometry(layer));
  const slider = element("peel");
  slider.max = data.layers.length - 1;
  slider.disabled = false;
  // What to show first may be said in the address, such as #peel=5&theme=dark.
  const wish = new URLSearchParams(location.hash.slice(1));
  if (wish.has("peel")) slider.value = wish.get("peel");
  if (themes[wish.get("theme")]) dress(wish.get("theme"));
  peel();
  draw();  // at once: whoever waits for the state finds the picture
  root.dataset.state = "ready";
}
start();
