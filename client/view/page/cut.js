// ---- The cut ----

// A plane across an axis. The far side is not drawn: surfaces, balls and, on request, the skeleton.
const cut = { axis: null, part: 0.5, flipped: false };
const kNowhere = new THREE.Plane(new THREE.Vector3(1, 0, 0), 1e6);
const surfacePlane = kNowhere.clone(), skeletonPlane = kNowhere.clone();
const cutBox = new THREE.Box3();
const cutFrame = new THREE.LineLoop(new THREE.BufferGeometry().setAttribute(
  "position", new THREE.BufferAttribute(new Float32Array(12), 3)), new THREE.LineBasicMaterial());
cutFrame.frustumCulled = false;
cutFrame.visible = false;

function prepareCut(box) {
  cutBox.copy(box).expandByScalar(0.01);
  scene.add(cutFrame);
  if (renderer) renderer.localClippingEnabled = true;
  const clip = (materials, plane) => {
    for (const material of materials) material.clippingPlanes = [plane];
  };
  clip([...core.materials, ...ghost.materials, ball.material], surfacePlane);
  clip([tubes.mesh, hoverMark, pinMark, sheets, ...Object.values(nodes)].filter(Boolean)
    .map(({ material }) => material), skeletonPlane);
}

const axisNumber = (name) => ["x", "y", "z"].indexOf(name);
function cutPlace() {
  const axis = axisNumber(cut.axis);
  const low = cutBox.min.getComponent(axis), high = cutBox.max.getComponent(axis);
  return low + cut.part * (high - low);
}
// For a point of the skeleton at an index in a list of coordinates.
function isCutOff(points, at) {
  const { normal: { x, y, z }, constant } = skeletonPlane;
  return x * points[at] + y * points[at + 1] + z * points[at + 2] + constant < 0;
}

function showCut() {
  const axis = axisNumber(cut.axis), on = axis >= 0;
  for (const name of ["off", "x", "y", "z"]) {
    element(`cut-${name}`).setAttribute("aria-pressed", name === (cut.axis ?? "off"));
  }
  element("cut-place").disabled = element("cut-flip").disabled = element("cut-all").disabled = !on;
  element("cut-place").value = cut.part;
  element("cut-flip").setAttribute("aria-pressed", cut.flipped);
  element("cut-at").textContent = on ? `${cut.axis} = ${measure(toWorld(cutPlace(), axis))}` : "";
  surfacePlane.copy(kNowhere);
  cutFrame.visible = on;
  if (on) {
    const sign = cut.flipped ? 1 : -1;
    surfacePlane.set(new THREE.Vector3().setComponent(axis, sign), -sign * cutPlace());
    frameCut(axis);
  }
  skeletonPlane.copy(element("cut-all").checked ? surfacePlane : kNowhere);
  // The cut shows the inside.
  const side = on ? THREE.DoubleSide : THREE.FrontSide;
  for (const material of [...core.materials, ...ghost.materials]) {
    if (material.side === side) continue;
    material.side = side;
    material.needsUpdate = true;
  }
  redraw();
}
function frameCut(axis) {
  const { min, max } = cutBox, [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
  const corner = new THREE.Vector3().setComponent(axis, cutPlace());
  const { position } = cutFrame.geometry.attributes;
  [[min, min], [max, min], [max, max], [min, max]].forEach(([a, b], n) => {
    corner.setComponent(u, a.getComponent(u)).setComponent(v, b.getComponent(v));
    corner.toArray(position.array, 3 * n);
  });
  position.needsUpdate = true;
}
function setCut(change) {
  Object.assign(cut, change);
  showCut();
}
function listenToCut() {
  for (const name of ["x", "y", "z"]) {
    element(`cut-${name}`).addEventListener("click", () => setCut({ axis: name }));
  }
  element("cut-off").addEventListener("click", () => setCut({ axis: null }));
  element("cut-place").addEventListener("input",
    (event) => setCut({ part: Number(event.target.value) }));
  element("cut-flip").addEventListener("click", () => setCut({ flipped: !cut.flipped }));
  element("cut-all").addEventListener("input", showCut);
}
