// ---- Glass ----

// Faint where the surface faces the viewer, dense toward its outlines, under a lamp from the upper
// left.
const glassVertex = `
attribute vec3 hue;  // black without
varying vec3 v_normal; varying vec3 v_view; varying vec3 v_hue;
#include <clipping_planes_pars_vertex>
void main() {
  vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
  v_normal = normalMatrix * normal;
  v_hue = hue;
  v_view = projectionMatrix[3][3] == 1.0 ? vec3(0.0, 0.0, 1.0) : -mvPosition.xyz;
  #include <clipping_planes_vertex>
  gl_Position = projectionMatrix * mvPosition;
}`;
const glassFragment = `
uniform vec3 tint; uniform float strength; uniform float body;
varying vec3 v_normal; varying vec3 v_view; varying vec3 v_hue;
#include <clipping_planes_pars_fragment>
void main() {
  #include <clipping_planes_fragment>
  vec3 n = normalize(v_normal), v = normalize(v_view), lamp = vec3(-0.45, 0.65, 0.61);
  if (dot(n, v) < 0.0) n = -n;
  float rim = 1.0 - dot(n, v), light = max(0.0, dot(n, lamp));
  float gleam = pow(max(0.0, dot(reflect(-lamp, n), v)), 30.0);
  vec3 color = (tint + v_hue) * (0.68 + 0.42 * light - 0.22 * rim) + 0.28 * gleam;
  float cover = body * (0.30 + 0.22 * (1.0 - light)) + 1.1 * pow(rim, 1.7) + 0.2 * gleam;
  gl_FragColor = vec4(color, clamp(strength * cover, 0.0, 1.0));
}`;

// First the depth, then the color of what is in front: one layer of glass instead of four.
class Glass {
  constructor(order, body) {
    this.depth = new THREE.Mesh(undefined, new THREE.MeshBasicMaterial(
      { colorWrite: false, transparent: true }));
    this.uniforms = { tint: { value: new THREE.Color() }, strength: { value: 1 },
                      body: { value: body } };
    this.color = new THREE.Mesh(undefined, new THREE.ShaderMaterial(
      { uniforms: this.uniforms, vertexShader: glassVertex, fragmentShader: glassFragment,
        transparent: true, depthWrite: false, clipping: true }));
    this.depth.renderOrder = order;
    this.color.renderOrder = order + 1;
    this.group = new THREE.Group().add(this.depth, this.color);
    this.group.visible = false;
    this.materials = [this.depth.material, this.color.material];
  }
  wrap(geometry) { this.depth.geometry = this.color.geometry = geometry; }
}

// ---- The scene ----

const canvas = element("scene"), stage = element("stage");
// Without WebGL everything except the picture still works.
function makeRenderer() {
  try {
    return new THREE.WebGLRenderer({ canvas, antialias: true });
  } catch {
    complain("This browser shows no 3D graphics: WebGL is switched off or not supported. " +
             "The table of branches and its export work without it.");
    return null;
  }
}
const renderer = makeRenderer();
const scene = new THREE.Scene(), camera = new THREE.Camera();
const lamp = new THREE.DirectionalLight(0xffffff, 0.75);
lamp.position.set(-0.45, 0.65, 0.61);
camera.add(lamp);
scene.add(camera, new THREE.AmbientLight(0xffffff, 0.5));

const core = new Glass(1, 1), ghost = new Glass(3, 0);
ghost.depth.visible = false;
const tubes = new Tubes(), nodes = nodeMeshes();
const hoverMark = new Marks(tubes, 1.1), pinMark = new Marks(tubes, 0.5);
// The largest ball inside the object around a point of the skeleton.
const ball = new THREE.Mesh(new THREE.SphereBufferGeometry(1, 40, 28), new THREE.MeshPhongMaterial(
  { transparent: true, opacity: 0.35, depthWrite: false }));
ball.visible = false;
ball.renderOrder = 0.5;  // behind the glass, before its depth
scene.add(core.group, ghost.group, tubes.mesh, ...Object.values(nodes), pinMark.mesh,
          hoverMark.mesh, ball);
let sheets = null;  // a mesh, if the skeleton has any

// ---- Drawing ----

// If drawing is slow, frames of a movement have fewer pixels, and the last one is drawn again with
// all.
const pace = { last: -Infinity, coarse: false, settling: 0 };
function keepPace(now) {
  const between = now - pace.last;
  pace.last = now;
  if (between > 70 && between < 2000) pace.coarse = true;
  clearTimeout(pace.settling);
  if (!pace.coarse) return;
  pace.settling = setTimeout(() => {
    Object.assign(pace, { last: -Infinity, coarse: false });
    redraw();
  }, 400);
}

// Draws only on request.
let asked = false;
function redraw() {
  if (asked) return;
  asked = true;
  requestAnimationFrame((now) => {
    asked = false;
    const moving = glide(now);
    keepPace(now);
    draw();
    if (moving) redraw();
  });
}

const drawn = { width: 0, height: 0, ratio: 0 };  // the canvas's current size
function fitCanvas(ratio) {
  const { clientWidth: width, clientHeight: height } = stage;
  if (drawn.width === width && drawn.height === height && drawn.ratio === ratio) return;
  Object.assign(drawn, { width, height, ratio });
  renderer?.setPixelRatio(ratio);
  renderer?.setSize(width, height, false);
}
function draw(ratio = Math.min(window.devicePixelRatio || 1, 2) * (pace.coarse ? 0.4 : 1)) {
  fitCanvas(ratio);
  placeCamera();
  renderer?.render(scene, camera);
  drawAxes();
  drawScale();
  placeLabels();
}

canvas.addEventListener("webglcontextlost", () => {
  complain("The graphics driver has stopped; the picture returns when it does.");
});
canvas.addEventListener("webglcontextrestored", () => {
  element("message").hidden = true;
  redraw();
});

// ---- Axes and scale ----

const axisColors = { x: "#e11d48", y: "#16a34a", z: "#3b82f6" };
function drawAxes() {
  const pen = element("axes").getContext("2d"), middle = 80, reach = 56;
  pen.clearRect(0, 0, 160, 160);
  pen.lineWidth = 3;
  pen.lineCap = "round";
  pen.font = "22px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  const turn = camera.quaternion.clone().inverse();
  const axes = Object.entries(axisColors).map(([name, color], axis) => (
    { name, color, v: new THREE.Vector3().setComponent(axis, 1).applyQuaternion(turn) }));
  for (const { name, color, v } of axes.sort((a, b) => a.v.z - b.v.z)) {
    pen.strokeStyle = pen.fillStyle = color;
    pen.beginPath();
    pen.moveTo(middle, middle);
    pen.lineTo(middle + reach * v.x, middle - reach * v.y);
    pen.stroke();
    pen.fillText(name, middle + 1.25 * reach * v.x, middle - 1.25 * reach * v.y);
  }
}

// A bar with the length of a round number of world units at the distance of the camera's target.
function scaleBar() {
  const pixel = 2 * halfHeight() / Math.max(drawn.height, 1) * edge, room = 140 * pixel;
  const power = 10 ** Math.floor(Math.log10(room));
  const round = [5, 2, 1].find((n) => n * power <= room) * power;
  return { width: round / pixel, text: measure(Number(round.toPrecision(2))) };
}
function drawScale() {
  const { width, text } = scaleBar();
  element("bar").style.width = `${width}px`;
  element("scale").textContent = text;
}
