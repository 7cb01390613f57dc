// ---- Camera ----

// `turn` around `target` and `climb` above it (radians), at a distance in edges of the scene.
const view = { turn: 0, climb: 0, distance: 1, target: new THREE.Vector3(), flat: false };
const first = { turn: THREE.Math.degToRad(data.front.turn), climb: THREE.Math.degToRad(data.front.climb) };
// From the frame of `turn` and `climb`.
const upright = new THREE.Quaternion().setFromRotationMatrix(new THREE.Matrix4().makeBasis(
  ...[data.front.right, data.front.up, data.front.toward].map((v) => new THREE.Vector3(...v))));
const wholeBox = new THREE.Box3();
const kHalfField = Math.tan(16 * Math.PI / 180);
const halfHeight = () => view.distance * kHalfField;

function copyOf({ turn, climb, distance, target, flat }) {
  return { turn, climb, distance, target: target.clone(), flat };
}

const cameraTurn = (turn, climb) => new THREE.Quaternion()
  .setFromEuler(new THREE.Euler(-climb, turn, 0, "YXZ")).premultiply(upright);

function placeCamera() {
  const { turn, climb, distance, target, flat } = view;
  camera.quaternion.copy(cameraTurn(turn, climb));
  camera.position.set(0, 0, distance).applyQuaternion(camera.quaternion).add(target);
  camera.updateMatrixWorld();
  const aspect = drawn.width / Math.max(drawn.height, 1);
  // Everything is within two edges of the target, unless the target was moved far away.
  const far = distance + 4 + 2 * target.length();
  const near = flat ? -far : Math.max(far / 5000, distance - 4);
  const up = flat ? halfHeight() : near * kHalfField;
  camera.projectionMatrix[flat ? "makeOrthographic" : "makePerspective"](
    -up * aspect, up * aspect, up, -up, near, far);
  camera.projectionMatrixInverse.getInverse(camera.projectionMatrix);
}

// From the initial side, as near as possible with the whole object in view.
function wholeView() {
  const { turn, climb } = first, target = wholeBox.getCenter(new THREE.Vector3());
  const toCamera = cameraTurn(turn, climb).inverse();
  const aspect = stage.clientWidth / Math.max(stage.clientHeight, 1), { min, max } = wholeBox;
  let distance = 1e-3;
  for (let corner = 0; corner < 8; ++corner) {
    const p = new THREE.Vector3(...["x", "y", "z"].map((axis, bit) =>
      (corner >> bit & 1 ? max : min)[axis])).sub(target).applyQuaternion(toCamera);
    const needed = Math.max(Math.abs(p.y), Math.abs(p.x) / aspect) / kHalfField;
    distance = Math.max(distance, p.z + needed);
  }
  return { turn, climb, target, distance: 1.12 * distance };
}

// ---- Movements ----

const kClimb = Math.PI / 2;
const still = window.matchMedia("(prefers-reduced-motion: reduce)");
let gliding = null;
// Animates to another view, or jumps for users who prefer reduced motion.
function glideTo(to) {
  gliding = { from: copyOf(view), to: { ...copyOf(view), ...to }, start: null };
  redraw();
}
// Returns whether the animation continues.
function glide(now) {
  if (!gliding) return false;
  const { from, to } = gliding;
  gliding.start ??= now;
  const part = still.matches ? 1 : Math.min(1, (now - gliding.start) / 280);
  const way = 1 - (1 - part) ** 3, between = (a, b) => a + (b - a) * way;
  // The shorter way around.
  const turn = ((to.turn - from.turn + 3 * Math.PI) % (2 * Math.PI) + 2 * Math.PI) % (2 * Math.PI);
  Object.assign(view, {
    turn: from.turn + (turn - Math.PI) * way, climb: between(from.climb, to.climb),
    distance: from.distance * (to.distance / from.distance) ** way, flat: to.flat,
    target: from.target.clone().lerp(to.target, way) });
  if (part === 1) gliding = null;
  return part < 1;
}

function moved() {
  gliding = null;
  redraw();
}
// Moves `right` around the object and `up` above it (radians), or nearer by a factor.
function orbit(right, up, nearer = 1) {
  view.turn += right;
  view.climb = Math.max(-kClimb, Math.min(kClimb, view.climb + up));
  view.distance = Math.max(1e-4, Math.min(100, view.distance * nearer));
  moved();
}
// Moves the target by screen pixels.
function pan(x, y) {
  const pixel = 2 * halfHeight() / Math.max(drawn.height, 1);
  view.target.add(new THREE.Vector3(-x * pixel, y * pixel, 0).applyQuaternion(camera.quaternion));
  moved();
}
// Keeps the scene point at this screen position in place.
function zoomAt(x, y, nearer) {
  const { distance } = view;
  orbit(0, 0, nearer);
  const part = 1 - distance / view.distance;
  pan((x - drawn.width / 2) * part, (y - drawn.height / 2) * part);
}
const reset = () => glideTo(wholeView());
function lookAlong(axis, sign) {
  const from = new THREE.Vector3().setComponent(axis, sign).applyQuaternion(
    upright.clone().inverse());
  const steep = Math.abs(from.y) > 0.999;
  glideTo({ turn: steep ? 0 : Math.atan2(from.x, from.z), climb: Math.asin(from.y) });
}
function setFlat(flat) {
  view.flat = flat;
  element("flat").setAttribute("aria-pressed", flat);
  moved();
}

// ---- Pointers ----

// A drag rotates; with the right button or a key it pans. Two fingers pan and zoom.
const fingers = new Map();
let way = 0;  // distance of the pointer since it was pressed
function spread() {
  const [a, b] = [...fingers.values()];
  return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y) };
}
function onDrag(event) {
  const before = fingers.get(event.pointerId), to = { x: event.offsetX, y: event.offsetY };
  const [x, y] = [to.x - before.x, to.y - before.y];
  way += Math.hypot(x, y);
  if (fingers.size === 2) {
    const old = spread();
    fingers.set(event.pointerId, to);
    const now = spread();
    zoomAt(now.x, now.y, old.apart / Math.max(now.apart, 1));
    return pan(now.x - old.x, now.y - old.y);
  }
  fingers.set(event.pointerId, to);
  if (event.buttons & 6 || event.shiftKey || event.ctrlKey || event.metaKey) return pan(x, y);
  orbit(-x * 2 * Math.PI / drawn.height, y * 2 * Math.PI / drawn.height);
}
function listenToPointers() {
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    if (fingers.size === 0) way = 0;
    fingers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    forget();
  });
  canvas.addEventListener("pointermove", (event) => {
    if (fingers.has(event.pointerId)) onDrag(event);
    else if (event.pointerType !== "touch") pointAt(event.offsetX, event.offsetY);
  });
  for (const type of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(type, (event) => {
      if (!fingers.delete(event.pointerId) || type === "pointercancel") return;
      if (way < 5 && fingers.size === 0 && event.button === 0) choose(event);
    });
  }
  canvas.addEventListener("pointerleave", () => pointAt(NaN, NaN));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === 1 ? 16 : 1);  // or lines
    zoomAt(event.offsetX, event.offsetY, Math.exp(Math.max(-240, Math.min(240, pixels)) / 600));
  }, { passive: false });
}
