// ---- Picking ----

// The returned function stores the screen position and the depth of a scene point in `to`; a point
// behind the viewer has no position.
function projector() {
  const m = new THREE.Matrix4().multiplyMatrices(
    camera.projectionMatrix, camera.matrixWorldInverse).elements;
  const { width, height } = drawn;
  return (x, y, z, to) => {
    const w = m[3] * x + m[7] * y + m[11] * z + m[15];
    to.w = w;
    to.x = (1 + (m[0] * x + m[4] * y + m[8] * z + m[12]) / w) / 2 * width;
    to.y = (1 - (m[1] * x + m[5] * y + m[9] * z + m[13]) / w) / 2 * height;
    return w > 0;
  };
}
const pixelsPerUnit = (w) => drawn.height / (2 * kHalfField * (view.flat ? view.distance : w));

function nodeUnder(x, y) {
  if (!element("show-nodes").checked) return null;
  const project = projector(), at = {};
  let reach = 9, found = null;
  for (const n of shown.nodes) {
    const place = nodePlaces.subarray(3 * n, 3 * n + 3);
    if (!isDrawn(n) || !project(...place, at) || isCutOff(place, 0)) continue;
    const away = Math.hypot(at.x - x, at.y - y);
    if (away < reach) [reach, found] = [away, n];
  }
  return found;
}

// Returns the edge, and its point, nearest to a screen position, within 14 pixels.
function edgeUnder(x, y) {
  if (!element("show-skeleton").checked) return null;
  const project = projector(), a = {}, b = {};
  let reach = 14, found = null;
  for (let place = 0; place < shown.edges; ++place) {
    const id = order[place], ball = 4 * id, radius = curveBalls[ball + 3];
    const front = project(curveBalls[ball], curveBalls[ball + 1], curveBalls[ball + 2], a);
    const room = reach + 1.2 * radius * pixelsPerUnit(a.w);
    if (front && a.w > 2 * radius && Math.hypot(a.x - x, a.y - y) > room) continue;
    let last = false;
    for (let n = curveStart[id]; n < curveStart[id + 1]; ++n) {
      const p = 3 * n;
      const here = project(curvePoints[p], curvePoints[p + 1], curvePoints[p + 2], b);
      if (here && !isCutOff(curvePoints, p)) {
        // The segment to the previous point, and the nearest position along it.
        const [u, v] = last ? [a.x - b.x, a.y - b.y] : [0, 0], square = u * u + v * v;
        const along = square > 0 ? ((x - b.x) * u + (y - b.y) * v) / square : 0;
        const part = Math.max(0, Math.min(1, along));
        const away = Math.hypot(b.x + part * u - x, b.y + part * v - y);
        if (away < reach) {
          reach = away;
          found = { id, n: n - curveStart[id] - (part > 0.5 ? 1 : 0) };
        }
      }
      last = here;
      [a.x, a.y] = [b.x, b.y];
    }
  }
  return found;
}

// ---- Tooltip ----

function aboutNode(n) {
  const node = nodeAt[n];
  const rows = [["radius", measure(node.radius)],
                ["at", `${node.position.map(figure).join(", ")} ${unit}`]];
  if (shown.degree.has(n)) rows.unshift(["branches", shown.degree.get(n)]);
  if (node.cavities) rows.push(["cavities", node.cavities]);
  return { title: `${words(shown.kindOf(n))} ${n}`, rows, place: nodePlaces.slice(3 * n, 3 * n + 3),
           radius: node.radius };
}
function aboutBranch({ id, n }) {
  const branch = branchWith(id), e = result.edges[id];
  const rows = [["length", measure(branch.length)], ["mean radius", measure(branch.mean)],
                ["min, max radius", `${figure(branch.min)}, ${measure(branch.max)}`],
                ["radius here", measure(e.radii[n])]];
  if (branch.tortuosity !== undefined) rows.push(["tortuosity", figure(branch.tortuosity)]);
  if (shown.parts.length > 1) rows.push([kPart.toLowerCase(), partName(branch.part)]);
  for (const { name, ofEdge } of Object.values(colorings)) {
    if (!ofEdge || name === "length") continue;
    rows.push([name, Number.isFinite(ofEdge(e)) ? figure(ofEdge(e)) : "never"]);
  }
  const at = curveStart[id] + n;
  return { title: `branch ${branch.id}`, detail: branch.kinds, rows,
           place: curvePoints.slice(3 * at, 3 * at + 3), radius: e.radii[n], branch };
}

function forget() {
  pointer.at = null;
  element("tip").hidden = true;
  ball.visible = false;
  mark(null);
  redraw();
}
// The highlighted branch: the one under the pointer or of the hovered row of the table.
function mark(branch) {
  hoverMark.show(branch ? [branch] : []);
  redraw();
}

function tell(found, x, y) {
  const tip = element("tip");
  tip.hidden = false;
  tip.innerHTML = `<b>${found.title}</b> ${found.detail || ""}<table>${found.rows.map(
    ([name, value]) => `<tr><th>${name}</th><td>${escaped(`${value}`)}</td></tr>`).join("")}</table>`;
  const within = (at, size, room) =>
    at + 20 + size + 8 > room ? Math.max(8, at - 20 - size) : at + 20;
  tip.style.left = `${within(x, tip.offsetWidth, drawn.width)}px`;
  tip.style.top = `${within(y, tip.offsetHeight, drawn.height)}px`;
  ball.visible = true;
  ball.position.set(...found.place);
  ball.scale.setScalar(Math.max(found.radius / edge, 1e-6));
  ball.material.color.copy(rampColor(found.radius, colorings.radius.range));
  mark(found.branch);
}

// Updated once per frame, however often the pointer moves.
const pointer = { at: null, asked: false };
function pointAt(x, y) {
  pointer.at = { x, y };
  if (pointer.asked) return;
  pointer.asked = true;
  requestAnimationFrame(() => {
    pointer.asked = false;
    if (pointer.at) look(pointer.at);
  });
}
function look({ x, y }) {
  const node = nodeUnder(x, y), found = node === null ? edgeUnder(x, y) : null;
  canvas.classList.toggle("aims", node !== null || found !== null);
  if (node !== null) tell(aboutNode(node), x, y);
  else if (found) tell(aboutBranch(found), x, y);
  else if (!element("tip").hidden) forget();
}

// ---- Pins ----

// By edge, so that a pin survives the joining of branches by pruning.
let pins = [];
const pinned = () => [...new Set(pins.map(branchWith).filter(Boolean))];
const isPinned = (branch) => pins.some((id) => branchWith(id) === branch);

function setPins(edges) {
  pins = edges;
  showPins();
}
function togglePin(branch) {
  setPins(isPinned(branch) ? pins.filter((id) => branchWith(id) !== branch)
                           : [...pins, branch.id]);
}
function choose(event) {
  const { offsetX: x, offsetY: y, pointerType } = event, found = edgeUnder(x, y);
  if (pointerType === "touch") look({ x, y });  // a finger cannot hover
  if (!found) return;
  const branch = branchWith(found.id);
  togglePin(branch);
  if (isPinned(branch)) reveal(branch);
}
function showPins() {
  const branches = pinned();
  pinMark.show(branches);
  element("pins").hidden = branches.length === 0;
  element("pinned").innerHTML = branches.map((b) => `<tr data-branch="${b.id}">
    <th><button class="go" title="Center the view on this branch">${b.id}</button></th>
    <td>${figure(b.length)}</td><td>${figure(b.mean)}</td>
    <td>${figure(b.min)} \u2013 ${figure(b.max)}</td>
    <td>${b.tortuosity === undefined ? "" : figure(b.tortuosity)}</td><td>${b.kinds}</td>
    <td><button class="off" aria-label="Unpin branch ${b.id}">\u2715</button></td></tr>`).join("");
  element("labels").replaceChildren(...branches.map((branch) => {
    const label = Object.assign(document.createElement("span"), { textContent: branch.id });
    label.place = middleOf(branch);
    return label;
  }));
  refreshRows();
  redraw();
}
// A point of the longest edge.
function middleOf({ edges }) {
  const length = (id) => result.edges[id].length;
  const id = edges.reduce((a, b) => length(b) > length(a) ? b : a);
  return curvePoint((curveStart[id] + curveStart[id + 1] - 1) >> 1);
}
function placeLabels() {
  const project = projector(), at = {};
  for (const label of element("labels").children) {
    const place = label.place.toArray();
    label.hidden = !project(...place, at) || isCutOff(place, 0);
    label.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
  }
}
// Centers the point and moves near enough to see it well, but never farther away.
function center(branch) {
  const box = new THREE.Box3();
  for (const id of branch.edges) {
    box.expandByPoint(new THREE.Vector3().fromArray(curveBalls, 4 * id)
      .addScalar(curveBalls[4 * id + 3]));
    box.expandByPoint(new THREE.Vector3().fromArray(curveBalls, 4 * id)
      .subScalar(curveBalls[4 * id + 3]));
  }
  const size = box.getSize(new THREE.Vector3()).length();
  glideTo({ target: middleOf(branch),
            distance: Math.min(view.distance, Math.max(3 * size / kHalfField / 2, 0.15)) });
}
