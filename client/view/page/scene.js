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
    this.group.visible = false;
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

// Where pictures take long, those of a movement are drawn with fewer pixels, and the last one again
// with all.
const pace = { last: -Infinity, coarse: false, settling: 0 };
function keepPace(now) {
  const between = now - pace.last;
  pace.last = now;
  if (between > 70 && between < 2000) pace.coarse = true;
  clearTimeout(pace.settling);
  if (!pace.coarse) return;
  pace.settling = setTimeout(() => {
    Object.assign(pace, { last: -Infinity, coarse: false });
    draw();
  }, 400);
}

let asked = false;
function redraw() {
  if (!asked) requestAnimationFrame((now) => { keepPace(now); draw(); });
  asked = true;
}
function draw() {
  asked = false;
  const width = window.innerWidth, height = window.innerHeight;
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2) * (pace.coarse ? 0.4 : 1));
  renderer.setSize(width, height, false);
  camera.aspect = width / height;
  // A little up, off the sliders.
  camera.setViewOffset(width, height, 0, Math.min(36, 0.04 * height), width, height);
  camera.updateProjectionMatrix();
  renderer.render(scene, camera);
  drawAxes();
  drawScale();
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
  const distance = Math.max(1.55 * size.length(), 1e-3) / aspect;
  camera.position.copy(center).addScaledVector(from.normalize(), distance);
  controls.target.copy(center);
  controls.update();
  controls.saveState();
}

// Around the object by `right` and over it by `up` (radians), or nearer by a factor.
function moveCamera(right, up, nearer) {
  const way = camera.position.clone().sub(controls.target);
  way.applyAxisAngle(camera.up, right);
  const climb = Math.PI / 2 - way.angleTo(camera.up);
  const most = Math.PI / 2 - 0.05;
  const side = new THREE.Vector3().crossVectors(camera.up, way).normalize();
  way.applyAxisAngle(side, climb - Math.max(-most, Math.min(most, climb + up)));
  camera.position.copy(controls.target).add(way.multiplyScalar(nearer));
  controls.update();
  redraw();
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

// A bar as long as a round number of world units at the distance of what the camera turns around.
function drawScale() {
  const distance = camera.position.distanceTo(controls.target);
  const pixel = 2 * distance * Math.tan(camera.fov * Math.PI / 360) / window.innerHeight * edge;
  const power = 10 ** Math.floor(Math.log10(140 * pixel));
  const round = [5, 2, 1].find((n) => n * power <= 140 * pixel) * power;
  element("bar").style.width = `${round / pixel}px`;
  element("scale").textContent = `${Number(round.toPrecision(2))} ${unit}`.trim();
}
