"use strict";

// Unpacks what the elements hold and runs the viewer: `data` are the surfaces and the points of
// curves, packed by packed_numbers.h, `result` the rest of the skeleton, as
// client/export/skeleton.schema.json says, `pruning` what the slider does (../pruning_steps.h), and
// `three` the library that draws.

const root = document.documentElement;
const element = (id) => document.getElementById(id);

function complain(text) {
  element("message").textContent = text;
  element("message").hidden = false;
}
function fail(error) {
  root.dataset.state = "failed";
  complain(`This page could not be built: ${error?.message ?? error}.`);
}
window.addEventListener("error", (event) => fail(event.error ?? event.message));
window.addEventListener("unhandledrejection", (event) => fail(event.reason));

async function inflate(text) {
  if (!window.DecompressionStream) throw new Error("the browser is too old, it unpacks no data");
  const binary = atob(text), bytes = new Uint8Array(binary.length);
  for (let n = 0; n < bytes.length; ++n) bytes[n] = binary.charCodeAt(n);
  const inflated = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(inflated).arrayBuffer());
}
async function unpack(text, count) {
  const packed = await inflate(text);
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
async function textOf(id) {
  const text = new TextDecoder().decode(await inflate(element(id).textContent));
  element(id).remove();
  return text;
}
function execute(text) {
  document.body.append(Object.assign(document.createElement("script"), { textContent: text }));
}

const data = JSON.parse(element("data").textContent);
let result = null, pruning = null;
// Of the points of all edges, one edge after the other: many small lists would be slow to search.
let curveStart = null;  // of an edge, then of the next one
let curvePoints = null;  // three coordinates each, in the cube around everything
async function unpackCurves({ edges, points, counts, radii, ranks, coordinates }) {
  const [countOf, rankOf, steps] = await Promise.all(
    [unpack(counts, edges), unpack(ranks, points), unpack(coordinates, 3 * points)]);
  curveStart = new Uint32Array(edges + 1);
  for (let id = 0; id < edges; ++id) curveStart[id + 1] = curveStart[id] + countOf[id];
  curvePoints = new Float32Array(3 * points);
  for (let n = 0; n < points; ++n) {
    for (let axis = 0; axis < 3; ++axis) {
      curvePoints[3 * n + axis] = steps[axis * points + n] / 2 ** 22;
    }
  }
  const radiusAt = Float64Array.from(rankOf, (rank) => radii[rank]);
  result.edges.forEach((e, id) => {
    e.radii = radiusAt.subarray(curveStart[id], curveStart[id + 1]);
  });
}
(async () => {
  execute(await textOf("three"));
  result = JSON.parse(await textOf("result"));
  pruning = JSON.parse(await textOf("pruning-steps"));
  await unpackCurves(data.curves);
  data.curves = null;
  execute(element("viewer").textContent);
})();
