// ---- Curves ----

const pointCount = curveStart[result.edges.length];
const curvePoint = (at) => new THREE.Vector3().fromArray(curvePoints, 3 * at);
// Center and radius of a ball around each curve.
const curveBalls = new Float32Array(4 * result.edges.length);
for (const id of result.edges.keys()) {
  const box = new THREE.Box3().setFromArray(
    curvePoints.subarray(3 * curveStart[id], 3 * curveStart[id + 1]));
  curveBalls.set([...box.getCenter(new THREE.Vector3()).toArray(),
                  box.getSize(new THREE.Vector3()).length() / 2], 4 * id);
}
const nodePlaces = new Float32Array(nodeAt.flatMap((n) => toScene(n.position)));

// Many curves and short ones must be thinner to stay distinguishable.
const sceneLength = result.edges.reduce((sum, e) => sum + e.length, 0) / edge;
const middleLength = result.edges.map((e) => e.length).sort((a, b) => a - b)
  [result.edges.length >> 1] / edge;
const kThickness = 0.0038 * Math.min(
  1, Math.max(0.2, Math.min(Math.sqrt(6 / Math.max(sceneLength, 1e-9)), 40 * (middleLength || 1))));
const kSides = pointCount > 100000 ? 4 : pointCount > 15000 ? 5 : 8;
const kStride = pointCount > 100000 ? 4 : pointCount > 15000 ? 2 : 1;

// ---- Tubes ----

// The points of a curve that get rings, and the first ring of each edge.
function* ringsOf(id) {
  const count = curveStart[id + 1] - curveStart[id];
  for (let n = 0; n < count - 1; n += kStride) yield n;
  if (count > 0) yield count - 1;
}
const ringStart = new Uint32Array(result.edges.length + 1);
for (const id of result.edges.keys()) ringStart[id + 1] = ringStart[id] + [...ringsOf(id)].length;
const ringCount = ringStart[result.edges.length];

// Rings around the curve that twist no more than the curve.
function addTube(id, positions, normals) {
  const at = [...ringsOf(id)].map((n) => curvePoint(curveStart[id] + n));
  const along = new THREE.Vector3(), other = new THREE.Vector3(), out = new THREE.Vector3();
  const side = new THREE.Vector3(0.36, 0.48, 0.8);
  let row = 3 * kSides * ringStart[id];
  for (let n = 0; n < at.length; ++n) {
    along.subVectors(at[Math.min(n + 1, at.length - 1)], at[Math.max(n - 1, 0)]).normalize();
    side.addScaledVector(along, -side.dot(along));
    if (side.lengthSq() < 1e-8) side.set(along.y, along.z, -along.x).cross(along);
    side.normalize();
    other.crossVectors(along, side);
    for (let k = 0; k < kSides; ++k, row += 3) {
      const angle = 2 * Math.PI * k / kSides;
      out.copy(side).multiplyScalar(Math.cos(angle)).addScaledVector(other, Math.sin(angle));
      out.toArray(normals, row);
      out.multiplyScalar(kThickness).add(at[n]).toArray(positions, row);
    }
  }
}

class Tubes {
  constructor() {
    const positions = new Float32Array(3 * kSides * ringCount);
    const normals = new Float32Array(positions.length);
    for (const id of result.edges.keys()) addTube(id, positions, normals);
    this.geometry = new THREE.BufferGeometry();
    for (const [name, array] of Object.entries(
      { position: positions, normal: normals, color: new Float32Array(positions.length) })) {
      this.geometry.setAttribute(name, new THREE.BufferAttribute(array, 3));
    }
    this.geometry.setIndex(new THREE.BufferAttribute(
      new Uint32Array(6 * kSides * ringCount), 1));
    this.mesh = new THREE.Mesh(this.geometry, new THREE.MeshPhongMaterial(
      { vertexColors: THREE.VertexColors, shininess: 60, specular: 0x222222 }));
    this.mesh.frustumCulled = false;
    this.place = new Uint32Array(result.edges.length);  // position of an edge in the order
    this.arrange();
  }
  // Sorts the triangles in the order in which edges are shown.
  arrange() {
    const { index } = this.geometry;
    this.indicesUpTo = new Uint32Array(order.length + 1);
    let at = 0;
    order.forEach((id, place) => {
      this.place[id] = place;
      for (let ring = ringStart[id] + 1; ring < ringStart[id + 1]; ++ring) {
        for (let k = 0; k < kSides; ++k) {
          const a = ring * kSides + k, b = ring * kSides + (k + 1) % kSides;
          index.array[at++] = a - kSides;
          index.array[at++] = b - kSides;
          index.array[at++] = b;
          index.array[at++] = a - kSides;
          index.array[at++] = b;
          index.array[at++] = a;
        }
      }
      this.indicesUpTo[place + 1] = at;
    });
    index.needsUpdate = true;
  }
  show(edges) { this.geometry.setDrawRange(0, this.indicesUpTo[edges]); }
  // The range of an edge's triangles.
  rangeOf(id) {
    const start = this.indicesUpTo[this.place[id]];
    return [start, this.indicesUpTo[this.place[id] + 1] - start];
  }
  paint() {
    const { color } = this.geometry.attributes;
    for (const [id, e] of result.edges.entries()) {
      const ofEdge = coloring.ofPoint ? null : edgeColor(id);
      let at = kSides * ringStart[id];
      for (const n of ringsOf(id)) {
        const { r, g, b } = ofEdge || rampColor(coloring.ofPoint(e, n), coloring.range);
        for (let k = 0; k < kSides; ++k) color.setXYZ(at++, r, g, b);
      }
    }
    color.needsUpdate = true;
  }
}

// Branches drawn again: wider, in one color, and in front of everything.
class Marks {
  constructor(tubes, width) {
    this.tubes = tubes;
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setAttribute("position", tubes.geometry.attributes.position);
    this.geometry.setAttribute("normal", tubes.geometry.attributes.normal);
    this.geometry.setIndex(tubes.geometry.index);
    this.material = new THREE.MeshBasicMaterial({ depthTest: false });
    this.material.onBeforeCompile = (shader) => {
      shader.uniforms.grow = { value: width * kThickness };
      shader.vertexShader = "uniform float grow;\n" + shader.vertexShader.replace(
        "#include <begin_vertex>", "vec3 transformed = position + normal * grow;");
    };
    this.mesh = new THREE.Mesh(this.geometry, [this.material]);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 0.2;
    this.show([]);
  }
  show(branches) {
    this.geometry.clearGroups();
    for (const id of branches.flatMap((b) => b.edges)) {
      this.geometry.addGroup(...this.tubes.rangeOf(id), 0);
    }
    this.mesh.visible = this.geometry.groups.length > 0;
  }
}

// ---- Sheets ----

// Lit from either side, each triangle separately, because sheets have no common orientation.
async function sheetMesh() {
  const geometry = await surfaceGeometry(data.sheets);
  const steps = await unpack(data.sheets.radii, data.sheets.vertices);
  const radii = Array.from(steps, (step) => step * data.step);
  const range = colorings.radius.range.add(radii);
  const colors = new THREE.BufferAttribute(new Float32Array(3 * radii.length), 3);
  geometry.setAttribute("color", colors);
  const mesh = new THREE.Mesh(geometry, new THREE.MeshPhongMaterial(
    { vertexColors: THREE.VertexColors, side: THREE.DoubleSide, flatShading: true, shininess: 30,
      specular: 0x222222 }));
  const parts = labels && await unpack(data.sheets.labels, data.sheets.vertices);
  if (labels) keepCorners(geometry, parts);
  mesh.paint = () => {
    const byLabel = coloring === colorings.label;
    radii.forEach((radius, n) => {
      const { r, g, b } = byLabel ? partColor(parts[n], theme.lightness) : rampColor(radius, range);
      colors.setXYZ(n, r, g, b);
    });
    colors.needsUpdate = true;
  };
  return mesh;
}

// ---- Nodes ----

const groupOf = (kind) => kind === "end" || kind === "junction" ? kind : "other";
// A loop's node only represents its curve.
const isDrawn = (n) => shown.kindOf(n) !== "loop";
function nodeMeshes() {
  const meshes = {};
  const many = { end: 0, junction: 0, other: 0 };
  for (const [, kind] of stateAt) ++many[groupOf(kind)];  // at most
  for (const group of ["end", "junction", "other"]) {
    const size = (group === "end" ? 1.8 : 2) * kThickness;
    const rings = many[group] > 20000 ? 3 : many[group] > 1000 ? 6 : many[group] > 200 ? 8 : 12;
    const mesh = new THREE.InstancedMesh(
      new THREE.SphereBufferGeometry(size, rings + rings / 3, rings),
      new THREE.MeshPhongMaterial({ shininess: 60, specular: 0x333333 }), many[group]);
    mesh.frustumCulled = false;
    mesh.show = () => {
      const place = new THREE.Matrix4();
      mesh.count = 0;
      for (const n of shown.nodes) {
        if (groupOf(shown.kindOf(n)) !== group || !isDrawn(n)) continue;
        place.setPosition(new THREE.Vector3().fromArray(nodePlaces, 3 * n));
        mesh.setMatrixAt(mesh.count++, place);
      }
      mesh.instanceMatrix.needsUpdate = true;
    };
    meshes[group] = mesh;
  }
  return meshes;
}
