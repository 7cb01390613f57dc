// ---- Colors ----

const themes = {
  light: { paper: 0xf6f8fb, glass: 0x7698c4, core: 0xd08a4e, end: 0x10b981, junction: 0x1f2937,
           other: 0x0284c7, lightness: 0.42,
           ramp: [0x2e1065, 0x7c1d82, 0xc42d60, 0xeb5e28, 0xf59e0b] },
  dark: { paper: 0x10151f, glass: 0x7fa8dd, core: 0xe0a06a, end: 0x34d399, junction: 0xcbd5e1,
          other: 0x38bdf8, lightness: 0.62,
          ramp: [0x7c6cff, 0xb95cf0, 0xff5f9e, 0xff9a57, 0xffe28a] },
};
let theme = themes.light;

// What edges can be colored by: a number per edge or per point, or just apart from each other.
const colorings = {
  radius: { name: "radius", ofPoint: (e, n) => e.radii[n] },
  branch: { name: "branch" },
  length: { name: "length", ofEdge: (e) => e.length },
  pruning: { name: "pruning level", ofEdge: (e) => e.pruning_level },
  strahler: { name: "Strahler order", ofEdge: (e) => e.strahler },
  generation: { name: "generation", ofEdge: (e) => e.generation },
};
for (const [id, coloring] of Object.entries(colorings)) {
  const { ofEdge } = coloring;
  if (ofEdge && !result.edges.some((e) => Number.isFinite(ofEdge(e)))) delete colorings[id];
}
let coloring = colorings.radius;

function rangeOf(numbers) {
  const range = { least: Infinity, most: -Infinity };
  for (const v of numbers) {
    if (!Number.isFinite(v)) continue;
    if (v < range.least) range.least = v;
    if (v > range.most) range.most = v;
  }
  return range;
}
const allRadii = result.nodes.map((n) => n.radius).concat(...result.edges.map((e) => e.radii));
for (const c of Object.values(colorings)) {
  c.range = rangeOf(c.ofEdge ? result.edges.map(c.ofEdge) : allRadii);
}

function rampColor(value, { least, most }) {
  const part = most > least ? Math.min(1, (value - least) / (most - least)) : 0.5;
  const place = part * (theme.ramp.length - 1);
  const stop = Math.min(Math.floor(place), theme.ramp.length - 2);
  return new THREE.Color(theme.ramp[stop]).lerp(new THREE.Color(theme.ramp[stop + 1]),
                                                place - stop);
}
// Neighboring numbers get hues far apart.
const branchColor = (id) =>
  new THREE.Color().setHSL((id * 0.618034) % 1, 0.68, theme.lightness);
function edgeColor(id) {
  if (coloring === colorings.branch) return branchColor(shown.branchOf(id));
  const value = coloring.ofEdge(result.edges[id]);
  return Number.isFinite(value) ? rampColor(value, coloring.range)
                                : new THREE.Color(theme.junction);
}

// ---- Pruning ----

const levelOf = (e) => e.pruning_level ?? Infinity;
const levels = [...new Set(result.edges.map(levelOf))].filter(Number.isFinite)
  .sort((a, b) => a - b);
// The branches that go last come first, so that those shown are always the first ones.
const byLevel = result.edges.map((_, id) => id)
  .sort((a, b) => levelOf(result.edges[b]) - levelOf(result.edges[a]) || a - b);

// What is left when the first `step` levels are pruned.
function prunedTo(step) {
  const least = step === 0 ? -Infinity : levels[step - 1];
  const degree = new Uint32Array(result.nodes.length);
  let edges = 0, length = 0;
  for (const id of byLevel) {
    const e = result.edges[id];
    if (levelOf(e) <= least) break;
    ++edges;
    ++degree[e.source];
    ++degree[e.target];
    length += e.length;
  }
  // A junction of two branches is none any more.
  const stays = ({ kind }, n) => kind === "isolated" || kind === "closed_surface" ||
    (degree[n] > 0 && !(step > 0 && kind === "junction" && degree[n] === 2));
  const nodes = result.nodes.map((_, n) => n).filter((n) => stays(result.nodes[n], n));
  const branches = branchesOf(byLevel.slice(0, edges), degree, new Set(nodes));
  return { step, edges, nodes, length, degree, ...branches };
}

// Edges that meet in a node that is none any more are one branch.
// Returns: `branchOf`, by edge, the first edge of its branch; `branches`, by first edge.
function branchesOf(ids, degree, nodes) {
  const next = Uint32Array.from(result.edges.keys());
  const firstOf = (id) => {
    while (next[id] !== id) id = next[id] = next[next[id]];
    return id;
  };
  const edgeAt = new Map();
  for (const id of ids) {
    for (const n of [result.edges[id].source, result.edges[id].target]) {
      if (degree[n] !== 2 || nodes.has(n)) continue;
      const [a, b] = [firstOf(edgeAt.get(n) ?? id), firstOf(id)];
      next[Math.max(a, b)] = Math.min(a, b);
      edgeAt.set(n, id);
    }
  }
  const branches = new Map();
  for (const id of ids) {
    const e = result.edges[id], first = firstOf(id);
    if (!branches.has(first)) branches.set(first, { edges: [], ends: [], length: 0 });
    const branch = branches.get(first);
    branch.edges.push(id);
    branch.length += e.length;
    branch.ends.push(...[e.source, e.target].filter((n) => nodes.has(n)));
  }
  return { branches, branchOf: firstOf };
}

let shown = prunedTo(0);

// ---- Shapes ----

// What an older version wrote has no smooth curves: there the steps of the lattice are smoothed
// away here.
function displayCurve(e) {
  let curve = (e.curve || e.points).map(toScene);
  for (let turn = e.curve ? 2 : 6; turn > 0; --turn) {
    curve = curve.map((p, n) => n === 0 || n === curve.length - 1 ? p :
      p.map((v, axis) => (curve[n - 1][axis] + 2 * v + curve[n + 1][axis]) / 4));
  }
  return curve;
}
const curves = result.edges.map(displayCurve);
const pointCount = curves.reduce((sum, c) => sum + c.length, 0);
// Many curves must be thinner to be told apart.
const sceneLength = result.edges.reduce((sum, e) => sum + e.length, 0) / edge;
const kThickness = 0.0038 * Math.min(1, Math.max(0.2, Math.sqrt(6 / Math.max(sceneLength, 1e-9))));
const kSides = pointCount > 100000 ? 4 : pointCount > 15000 ? 5 : 8;
const kStride = pointCount > 100000 ? 4 : pointCount > 15000 ? 2 : 1;
// The points of a curve that rings are put around.
const ringsOf = curves.map((curve) => curve.map((_, n) => n)
  .filter((n) => n % kStride === 0 || n === curve.length - 1));

// Rings around the curve, turned no more than it turns.
function addTube(id, tubes) {
  const at = ringsOf[id].map((n) => new THREE.Vector3(...curves[id][n]));
  const along = new THREE.Vector3(), other = new THREE.Vector3(), out = new THREE.Vector3();
  const side = new THREE.Vector3(0.36, 0.48, 0.8);
  for (let n = 0; n < at.length; ++n) {
    along.subVectors(at[Math.min(n + 1, at.length - 1)], at[Math.max(n - 1, 0)]).normalize();
    side.addScaledVector(along, -side.dot(along));
    if (side.lengthSq() < 1e-8) side.set(along.y, along.z, -along.x).cross(along);
    side.normalize();
    other.crossVectors(along, side);
    const first = tubes.vertices;
    for (let k = 0; k < kSides; ++k) {
      const angle = 2 * Math.PI * k / kSides, row = 3 * tubes.vertices++;
      out.copy(side).multiplyScalar(Math.cos(angle)).addScaledVector(other, Math.sin(angle));
      out.toArray(tubes.normals, row);
      out.multiplyScalar(kThickness).add(at[n]).toArray(tubes.positions, row);
      if (n === 0) continue;
      const a = first + k, b = first + (k + 1) % kSides;
      tubes.corners.set([a - kSides, b - kSides, b, a - kSides, b, a], tubes.indices);
      tubes.indices += 6;
    }
  }
}

function tubeMesh() {
  const vertices = ringsOf.reduce((sum, rings) => sum + rings.length, 0) * kSides;
  const tubes = { positions: new Float32Array(3 * vertices), normals: new Float32Array(3 * vertices),
                  corners: new Uint32Array(6 * vertices), vertices: 0, indices: 0 };
  const indicesUpTo = [0];
  for (const id of byLevel) {
    addTube(id, tubes);
    indicesUpTo.push(tubes.indices);
  }
  const geometry = new THREE.BufferGeometry();
  const attribute = (array) => new THREE.BufferAttribute(array, 3);
  geometry.setAttribute("position", attribute(tubes.positions));
  geometry.setAttribute("normal", attribute(tubes.normals));
  geometry.setAttribute("color", attribute(new Float32Array(3 * vertices)));
  geometry.setIndex(new THREE.BufferAttribute(tubes.corners, 1));
  const mesh = new THREE.Mesh(geometry, new THREE.MeshPhongMaterial(
    { vertexColors: THREE.VertexColors, shininess: 60, specular: 0x222222 }));
  mesh.show = (edges) => geometry.setDrawRange(0, indicesUpTo[edges]);
  return mesh;
}

function colorTubes(mesh) {
  const colors = mesh.geometry.attributes.color;
  let at = 0;
  for (const id of byLevel) {
    const e = result.edges[id], ofEdge = coloring.ofPoint ? null : edgeColor(id);
    for (const n of ringsOf[id]) {
      const { r, g, b } = ofEdge || rampColor(coloring.ofPoint(e, n), coloring.range);
      for (let k = 0; k < kSides; ++k) colors.setXYZ(at++, r, g, b);
    }
  }
  colors.needsUpdate = true;
}

// ---- Sheets ----

// Lit from either side, each triangle by itself: sheets meet and have no sides in common.
async function sheetMesh() {
  const geometry = await surfaceGeometry(data.sheets);
  const steps = await unpack(data.sheets.radii, data.sheets.vertices);
  const radii = Array.from(steps, (step) => step * data.step);
  const { range } = colorings.radius, { least, most } = rangeOf(radii);
  Object.assign(range, { least: Math.min(range.least, least), most: Math.max(range.most, most) });
  const colors = new THREE.BufferAttribute(new Float32Array(3 * radii.length), 3);
  geometry.setAttribute("color", colors);
  const mesh = new THREE.Mesh(geometry, new THREE.MeshPhongMaterial(
    { vertexColors: THREE.VertexColors, side: THREE.DoubleSide, flatShading: true, shininess: 30,
      specular: 0x222222 }));
  mesh.paint = () => {
    radii.forEach((radius, n) => {
      const { r, g, b } = rampColor(radius, range);
      colors.setXYZ(n, r, g, b);
    });
    colors.needsUpdate = true;
  };
  return mesh;
}

const groupOf = (kind) => kind === "end" || kind === "junction" ? kind : "other";
// A loop's node only stands for its curve.
const isDrawn = ({ kind }) => kind !== "loop";
function nodeMeshes() {
  const meshes = {};
  for (const group of ["end", "junction", "other"]) {
    const many = result.nodes.filter((n) => groupOf(n.kind) === group && isDrawn(n)).length;
    const size = (group === "end" ? 1.8 : 2) * kThickness;
    const mesh = new THREE.InstancedMesh(
      new THREE.SphereBufferGeometry(size, many > 2000 ? 8 : 16, many > 2000 ? 6 : 12),
      new THREE.MeshPhongMaterial({ shininess: 60, specular: 0x333333 }), many);
    mesh.frustumCulled = false;
    mesh.show = (rows) => {
      const here = rows.map((n) => result.nodes[n])
        .filter((n) => groupOf(n.kind) === group && isDrawn(n));
      here.forEach((n, at) => mesh.setMatrixAt(
        at, new THREE.Matrix4().makeTranslation(...toScene(n.position))));
      mesh.count = here.length;
      mesh.instanceMatrix.needsUpdate = true;
    };
    meshes[group] = mesh;
  }
  return meshes;
}
