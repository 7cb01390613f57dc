"use strict";

// The scripts share one scope and run in the order that ../CMakeLists.txt lists.

const unit = { unknown: "", um: "\u00b5m" }[result.unit] ?? result.unit ?? "";

// ---- Figures ----

const figure = (v) => Number(v.toPrecision(4)).toString();
const measure = (v) => `${figure(v)} ${unit}`.trim();
const digits = (n) => n.toLocaleString("en-US");
const counted = (n, one, many) => `${digits(n)} ${n === 1 ? one : many}`;
const escaped = (text) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const words = (kind) => escaped(kind.replace("_", " "));

// ---- Parts ----

// What tables list and hide: components, or labels if there are many. Numbers count from 0, names
// are text: labels may have 64 bits.
const { labels } = data;
const kPart = labels ? "Label" : "Component";
const partName = (part) => labels ? labels.names[part] : `${part}`;
const labelOfComponent = [];
labels?.of_nodes.forEach((label, n) => {
  labelOfComponent[result.nodes[n].component ?? 0] = label;
});
const partOf = ({ component = 0 }) => labels ? labelOfComponent[component] : component;

// ---- Surfaces ----

// The scene is the world, moved and scaled so that the cube around everything has edges of 1.
const edge = 65535 * data.step;
const toScene = (p) => p.map((v, axis) => (v - data.low[axis]) / edge);
const toWorld = (v, axis) => v * edge + data.low[axis];

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
  if (layer.parts) tintParts(geometry, layer.parts);
  return geometry;
}

// Each label's glass in its color.
function tintParts(geometry, parts) {
  const partAt = new Uint32Array(geometry.attributes.position.count);
  const hues = new Float32Array(3 * partAt.length);
  let at = 0;
  parts.forEach((triangles, part) => {
    const { r, g, b } = partColor(part, 0.55);
    for (const end = at + 3 * triangles; at < end; ++at) {
      const corner = geometry.index.array[at];
      hues.set([r, g, b], 3 * corner);
      partAt[corner] = part;
    }
  });
  geometry.setAttribute("hue", new THREE.BufferAttribute(hues, 3));
  keepCorners(geometry, partAt);
}
// For hideParts(), which leaves out the triangles of hidden labels.
function keepCorners(geometry, partAt) {
  Object.assign(geometry.userData, { corners: geometry.index.array.slice(), partAt });
}
function hideParts(geometry, hidden) {
  const { index, userData: { corners, partAt } } = geometry;
  let count = 0;
  for (let n = 0; n < corners.length; n += 3) {
    if (hidden.has(partAt[corners[n]])) continue;
    for (let k = 0; k < 3; ++k) index.array[count++] = corners[n + k];
  }
  index.needsUpdate = true;
  geometry.setDrawRange(0, count);
}
