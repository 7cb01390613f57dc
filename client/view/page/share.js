// ---- Files ----

function save(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = data.title.replace(/\.[^.]+$/, "").replace(/[^\w.-]+/g, "_") + name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// The branch table of the command line (client/export/graph_formats.h), for the listed branches in
// their order.
function branchCsv() {
  const ordered = result.order !== undefined;
  const head = [...(labels ? ["label"] : []), "skeleton_id", "branch_id", "node_id_src", "node_id_dst", "branch_type",
                "branch_distance", "euclidean_distance", "tortuosity", "mean_radius", "min_radius",
                "max_radius", "coord_src_x", "coord_src_y", "coord_src_z", "coord_dst_x",
                "coord_dst_y", "coord_dst_z", "pruning_level",
                ...(ordered ? ["generation", "strahler"] : []), "world", "unit"];
  const quoted = (text) => /[",]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  const frame = [result.world, result.unit].map((text) => quoted(text || "unknown"));
  const rows = table.rows.map((b) => [
    ...(labels ? [partName(b.part)] : []), b.component, b.id, b.source, b.target, b.type, b.length, b.straight, b.tortuosity, b.mean,
    b.min, b.max, ...nodeAt[b.source].position, ...nodeAt[b.target].position, b.level,
    ...(ordered ? [b.generation, b.strahler] : []), ...frame]);
  return [head, ...rows].map((row) => row.join()).join("\n") + "\n";
}
function saveCsv() {
  if (table.about !== "branches") showTable("branches");
  listRows();
  save(".csv", new Blob([branchCsv()], { type: "text/csv" }));
}

// The picture with the scale and the axes.
function savePicture(ratio) {
  const picture = document.createElement("canvas"), pen = picture.getContext("2d");
  draw(ratio);  // in the same task as the copy: afterwards the canvas is empty
  picture.width = canvas.width;
  picture.height = canvas.height;
  pen.drawImage(canvas, 0, 0);
  redraw();
  pen.scale(ratio, ratio);
  const { width, text } = scaleBar(), right = drawn.width - 24, bottom = drawn.height - 24;
  const style = getComputedStyle(element("ruler"));
  pen.strokeStyle = pen.fillStyle = style.color;
  pen.lineWidth = 1.5;
  pen.strokeRect(right - width, bottom, width, 0);
  for (const x of [right - width, right]) pen.strokeRect(x, bottom - 6, 0, 6);
  pen.font = `13px ${style.fontFamily}`;
  pen.textAlign = "center";
  pen.fillText(text, right - width / 2, bottom - 12);
  pen.drawImage(element("axes"), right - 80, bottom - 116, 80, 80);
  return new Promise((done) => picture.toBlob((blob) => {
    save(ratio === 1 ? ".png" : `@${ratio}x.png`, blob);
    done();
  }));
}

// ---- Links ----

const round = (v) => Number(v.toFixed(4));
// The differences from a newly opened page, in the form of the address.
function stateText() {
  const state = new URLSearchParams();
  const slider = (id, name = id) => {
    const { value, defaultValue } = element(id);
    if (value !== defaultValue) state.set(name, value);
  };
  for (const id of ["peel", "prune"]) slider(id);
  slider("strength", "glass");
  if (coloring !== colorings[kFirstColoring]) state.set("color", element("color").value);
  if (flipped) state.set("theme", root.dataset.theme);
  const { turn, climb, distance, target, flat } = view;
  state.set("view", [turn, climb, distance, ...target.toArray()].map(round).join("_"));
  if (flat) state.set("flat", 1);
  if (pins.length) state.set("pins", pins.join("."));
  if (cut.axis) state.set("cut", [cut.axis, round(cut.part), ...(cut.flipped ? ["back"] : []),
                                  ...(element("cut-all").checked ? ["all"] : [])].join("_"));
  const visible = shown.parts.map(({ id }) => id).filter((id) => !hidden.has(id));
  if (hidden.size > visible.length) state.set("only", visible.join("."));
  else if (hidden.size) state.set("hide", [...hidden].join("."));
  const off = ["object", "skeleton", "nodes"].filter((name) => !element(`show-${name}`).checked);
  if (off.length) state.set("off", off.join("."));
  return state.toString();
}

const numbersOf = (text) => (text ?? "").split(/[._]/).filter(Boolean).map(Number);
function grant(wish) {
  for (const [id, name] of [["peel", "peel"], ["prune", "prune"], ["strength", "glass"]]) {
    const value = parseFloat(wish.get(name));
    element(id).value = Number.isFinite(value) ? value : element(id).defaultValue;
  }
  const off = (wish.get("off") ?? "").split(".");
  for (const name of ["object", "skeleton", "nodes"]) {
    element(`show-${name}`).checked = !off.includes(name);
  }
  if (themes[wish.get("theme")]) {
    flipped = true;
    dress(wish.get("theme"));
  }
  paint(colorings[wish.get("color")] ? wish.get("color") : kFirstColoring);
  const only = new Set(numbersOf(wish.get("only")));
  setHidden(wish.has("only") ? shown.parts.map(({ id }) => id).filter((id) => !only.has(id))
                             : numbersOf(wish.get("hide")));
  setPins(numbersOf(wish.get("pins")).filter((id) => id in result.edges));
  const [axis, part, ...more] = (wish.get("cut") ?? "").split("_");
  element("cut-all").checked = more.includes("all");
  setCut({ axis: axisColors[axis] ? axis : null, flipped: more.includes("back"),
           part: Math.max(0, Math.min(1, Number(part ?? 0.5))) || 0 });
  const place = (wish.get("view") ?? "").split("_").map(Number);
  if (place.length === 6 && place.every(Number.isFinite) && place[2] > 0) {
    const [turn, climb, distance, ...target] = place;
    Object.assign(view, { turn, climb, distance, target: new THREE.Vector3(...target) });
  }
  setFlat(wish.has("flat"));
  showParts();
}
const wished = () => new URLSearchParams(location.hash.slice(1));

let toastEnds = 0;
function say(text) {
  element("toast").textContent = text;
  element("toast").hidden = false;
  clearTimeout(toastEnds);
  toastEnds = setTimeout(() => { element("toast").hidden = true; }, 4000);
}
async function copyLink() {
  if (location.protocol === "about:") {
    return say("Here the page has no address; open it as a file.");
  }
  const address = `${location.href.split("#")[0]}#${stateText()}`;
  try {
    history.replaceState(null, "", address);
  } catch { /* a page inside of another may have no address of its own */ }
  try {
    await navigator.clipboard.writeText(address);
    say("Link copied: it shows just this view.");
  } catch {
    say("The browser did not let the link be copied; the address bar holds it.");
  }
}
