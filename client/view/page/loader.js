"use strict";

// Unpacks what the elements hold and runs the viewer: `data` are the surfaces, packed by
// packed_numbers.h, `result` the skeleton, as client/export/skeleton.schema.json says, and `three`
// the library that draws.

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
async function textOf(id) {
  const text = new TextDecoder().decode(await inflate(element(id).textContent));
  element(id).remove();
  return text;
}
function execute(text) {
  document.body.append(Object.assign(document.createElement("script"), { textContent: text }));
}

const data = JSON.parse(element("data").textContent);
let result = null;
(async () => {
  execute(await textOf("three"));
  result = JSON.parse(await textOf("result"));
  execute(element("viewer").textContent);
})();
