// ---- Columns ----

const inUnit = (name) => unit ? `${name} (${unit})` : name;
const numberColumn = (key, title) => ({ key, title, show: (row) =>
  row[key] === undefined ? "" : figure(row[key]) });
const many = labels || result.nodes.some((n) => n.component > 0);
// A label's number is close enough for an order; its name is exact.
const partColumn = (key, partAt) => ({ key: labels ? "label" : key, title: kPart,
                                       show: (row) => partName(partAt(row)) });
const kColumns = {
  branches: [
    { key: "id", title: "Branch", show: (b) => b.id },
    ...(many ? [partColumn("component", (b) => b.part)] : []),
    { key: "kinds", title: "Ends", text: true, show: (b) => b.kinds },
    numberColumn("length", inUnit("Length")), numberColumn("mean", inUnit("Mean radius")),
    numberColumn("min", inUnit("Min radius")), numberColumn("max", inUnit("Max radius")),
    numberColumn("tortuosity", "Tortuosity"),
    ...(levels.length ? [numberColumn("level", "Pruning level")] : []),
    ...(colorings.strahler ? [numberColumn("strahler", "Strahler order")] : []),
    ...(colorings.generation ? [numberColumn("generation", "Generation")] : []),
  ],
  components: [
    { key: "shown", title: "Shown", text: true,
      show: (c) => hidden.has(c.id) ? "\u2610" : "\u2611" },
    partColumn("id", (c) => c.id),
    { key: "branches", title: "Branches", show: (c) => digits(c.branches) },
    { key: "nodes", title: "Nodes", show: (c) => digits(c.nodes) },
    numberColumn("length", inUnit("Length")), numberColumn("max", inUnit("Max radius")),
    { key: "only", title: "", text: true, show: () => "only" },
  ],
};

// ---- Filter and order of rows ----

const table = { about: "branches", rows: [],
                sort: { branches: ["id", 1], components: [labels ? "label" : "id", 1] },
                at: 0, filter: "" };
const kRow = 28;  // pixels, as in style.css

// `12 end length>5`: numbers are ids, words match the text, and a row must match all.
function filterOf(text, columns) {
  const tests = text.toLowerCase().split(/\s+/).filter(Boolean).map((term) => {
    const [, name, sign, limit] = term.match(/^([a-z]+)(<=|>=|<|>|=)(-?[\d.]+(?:e-?\d+)?)$/) ?? [];
    const column = name && columns.find(({ key, title }) => key !== "only" &&
      (key.startsWith(name) || title.toLowerCase().replace(/ /g, "").startsWith(name)));
    if (column) {
      const against = { "<": (v) => v < limit, ">": (v) => v > limit, "<=": (v) => v <= limit,
                        ">=": (v) => v >= limit, "=": (v) => v === Number(limit) }[sign];
      return (row) => row[column.key] !== undefined && against(Number(row[column.key]));
    }
    if (/^\d+$/.test(term)) {
      return (row) => row.edges ? row.id === Number(term) : partName(row.id) === term;
    }
    return (row) => (row.kinds ?? "").includes(term);
  });
  return (row) => tests.every((test) => test(row));
}

function listRows() {
  const all = table.about === "branches" ? [...shown.branches.values()] : shown.parts;
  const [key, sign] = table.sort[table.about];
  const value = key === "shown" ? (row) => Number(!hidden.has(row.id)) : (row) => row[key];
  const compare = (a, b) => a < b ? -sign : a > b ? sign : 0;
  // Rows without a value come last in either order.
  table.rows = all.filter(filterOf(table.filter, kColumns[table.about])).sort((a, b) => {
    const [u, v] = [value(a), value(b)];
    return (u === undefined) - (v === undefined) || compare(u, v) || a.id - b.id;
  });
  table.at = Math.max(0, Math.min(table.at, table.rows.length - 1));
  showHeads();
  element("found").textContent = table.rows.length === all.length ? ""
    : `${digits(table.rows.length)} of ${digits(all.length)}`;
  element("rows").setAttribute("aria-rowcount", table.rows.length + 1);
  element("filler").style.height = `${kRow * table.rows.length}px`;
  element("none").hidden = table.rows.length > 0;
  element("none").textContent = all.length > 0 ? "Nothing matches the filter."
    : table.about === "branches" ? "No branches are shown." : "The skeleton is empty.";
  refreshRows();
}

// ---- Visible rows ----

function showHeads() {
  const columns = kColumns[table.about], [key, sign] = table.sort[table.about];
  const widths = columns.map(({ text, title }) => text ? 150 : Math.max(76, 6 * title.length + 36));
  const { style } = element("rows");
  style.setProperty("--columns", widths.map((width) => `minmax(${width}px, ${width}fr)`).join(" "));
  style.setProperty("--width", `${widths.reduce((a, b) => a + b, 24)}px`);
  element("heads").innerHTML = columns.map((c) => `<span role="columnheader"
    class="${c.text ? "text" : ""}" aria-sort="${c.key !== key ? "none"
    : sign > 0 ? "ascending" : "descending"}">${c.title &&
    `<button data-key="${c.key}">${escaped(c.title)}</button>`}</span>`).join("");
}

const isOpen = () => !element("dock").classList.contains("closed");
// Only visible rows are elements, and they are reused: a click needs the element that was pressed
// to still exist.
function refreshRows() {
  if (!isOpen()) return;
  const rows = element("rows"), body = element("body"), columns = kColumns[table.about];
  const first = Math.max(0, Math.floor(rows.scrollTop / kRow) - 4);
  const last = Math.min(table.rows.length, first + Math.ceil(rows.clientHeight / kRow) + 8);
  const chosen = new Set(pinned());
  body.style.transform = `translateY(${first * kRow}px)`;
  while (body.children.length > last - first) body.lastChild.remove();
  while (body.children.length < last - first) body.append(document.createElement("div"));
  for (const [n, line] of [...body.children].entries()) {
    const place = first + n, row = table.rows[place];
    if (line.about !== table.about) makeCells(line, columns);
    line.id = `row-${place}`;
    line.place = place;
    line.setAttribute("aria-rowindex", place + 2);
    line.setAttribute("aria-selected", row.edges ? chosen.has(row) : !hidden.has(row.id));
    line.className = place === table.at ? "at" : "";
    columns.forEach((column, at) => { line.children[at].textContent = column.show(row); });
  }
  rows.setAttribute("aria-activedescendant", `row-${table.at}`);
}
function makeCells(line, columns) {
  line.about = table.about;
  line.setAttribute("role", "row");
  line.innerHTML = columns.map(({ key, text }) =>
    `<span role="gridcell" class="${key} ${text ? "text" : ""}"></span>`).join("");
}
let rowsAsked = false;
function refreshSoon() {
  if (!rowsAsked) requestAnimationFrame(() => { rowsAsked = false; refreshRows(); });
  rowsAsked = true;
}

function goToRow(place) {
  table.at = Math.max(0, Math.min(place, table.rows.length - 1));
  const rows = element("rows"), top = table.at * kRow, room = rows.clientHeight - kRow;
  if (top < rows.scrollTop) rows.scrollTop = top;
  if (top + kRow > rows.scrollTop + room) rows.scrollTop = top + kRow - room;
  refreshRows();
}
function reveal(branch) {
  const place = table.about === "branches" ? table.rows.indexOf(branch) : -1;
  if (isOpen() && place >= 0) goToRow(place);
}

// ---- Interaction ----

function openDock(open) {
  element("dock").classList.toggle("closed", !open);
  element("dock-toggle").setAttribute("aria-expanded", open);
  if (open) listRows();
}
function showTable(about) {
  table.about = about;
  table.at = 0;
  for (const name of Object.keys(kColumns)) {
    element(`tab-${name}`).setAttribute("aria-selected", name === about);
  }
  element("rows").scrollTop = 0;
  element("rows").setAttribute("aria-label", about);
  openDock(true);
}
function sortBy(key) {
  const [before, sign] = table.sort[table.about];
  table.sort[table.about] = [key, key === before ? -sign : 1];
  listRows();
  element("heads").querySelector(`[data-key="${key}"]`).focus();
}
function setHidden(parts) {
  hidden.clear();
  for (const part of parts) hidden.add(part);
  order = hidden.size ? byLevel.filter((id) => !hidden.has(edgePart(id))) : byLevel;
  tubes.arrange();
  if (labels) [layers[0], sheets?.geometry].filter(Boolean).forEach((g) => hideParts(g, hidden));
  prune();
}
function useRow(place, alone) {
  const row = table.rows[place];
  if (!row) return;
  table.at = place;
  if (table.about === "branches") {
    togglePin(row);
    if (isPinned(row)) center(row);
    return;
  }
  const others = shown.parts.map(({ id }) => id).filter((id) => id !== row.id);
  const lonely = others.every((id) => hidden.has(id)) && !hidden.has(row.id);
  if (alone) setHidden(lonely ? [] : others);
  else if (hidden.has(row.id)) setHidden([...hidden].filter((id) => id !== row.id));
  else setHidden([...hidden, row.id]);
}
function onRowKey(event) {
  const { at, rows } = table;
  const page = Math.max(1, Math.floor(element("rows").clientHeight / kRow) - 2);
  const to = { ArrowDown: at + 1, ArrowUp: at - 1, PageDown: at + page, PageUp: at - page, Home: 0,
               End: rows.length - 1 }[event.key];
  if (event.target !== element("rows") || event.ctrlKey || event.metaKey || event.altKey) return;
  if (to !== undefined) {
    goToRow(to);
    if (table.about === "branches") mark(rows[table.at]);
  } else if (event.key === "Enter" || event.key === " ") {
    useRow(at, event.shiftKey);
  } else {
    return;
  }
  event.preventDefault();
  event.stopPropagation();
}

function listenToTable() {
  const rows = element("rows"), placeOf = ({ target }) => target.closest("#body > div")?.place;
  for (const name of Object.keys(kColumns)) {
    element(`tab-${name}`).addEventListener("click", () => showTable(name));
  }
  element("dock-toggle").addEventListener("click", () => openDock(!isOpen()));
  element("search").addEventListener("input", (event) => {
    table.filter = event.target.value;
    rows.scrollTop = 0;
    openDock(true);
  });
  rows.addEventListener("scroll", refreshSoon);
  rows.addEventListener("keydown", onRowKey);
  rows.addEventListener("click", (event) => {
    const { key } = event.target.dataset, place = placeOf(event);
    if (key) sortBy(key);
    else if (place !== undefined) useRow(place, event.target.classList.contains("only"));
  });
  rows.addEventListener("pointerover", (event) => {
    const place = placeOf(event);
    if (table.about === "branches") mark(table.rows[place]);
  });
  for (const type of ["pointerleave", "blur"]) rows.addEventListener(type, () => mark(null));
  new ResizeObserver(refreshSoon).observe(rows);
}
