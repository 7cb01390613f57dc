// ---- Themes ----

const themes = {
  light: { paper: 0xf6f8fb, glass: 0x7698c4, core: 0xd08a4e, end: 0x10b981, junction: 0x1f2937,
           other: 0x0284c7, mark: 0x00a3d7, lightness: 0.42,
           ramp: [0x2e1065, 0x7c1d82, 0xc42d60, 0xeb5e28, 0xf59e0b] },
  dark: { paper: 0x10151f, glass: 0x7fa8dd, core: 0xe0a06a, end: 0x34d399, junction: 0xcbd5e1,
          other: 0x38bdf8, mark: 0x22e1ff, lightness: 0.62,
          ramp: [0x7c6cff, 0xb95cf0, 0xff5f9e, 0xff9a57, 0xffe28a] },
};
let theme = themes.light;

// ---- Colors of edges ----

// By a number per edge or per point, or only to tell edges apart.
const colorings = {
  ...(labels ? { label: { name: "label" } } : {}),
  radius: { name: "radius", unit, ofPoint: (e, n) => e.radii[n] },
  branch: { name: "branch" },
  length: { name: "length", unit, ofEdge: (e) => e.length },
  pruning: { name: "pruning level", ofEdge: (e) => e.pruning_level },
  strahler: { name: "Strahler order", ofEdge: (e) => e.strahler },
  generation: { name: "generation", ofEdge: (e) => e.generation },
};
for (const [id, { ofEdge }] of Object.entries(colorings)) {
  if (ofEdge && !result.edges.some((e) => Number.isFinite(ofEdge(e)))) delete colorings[id];
}
const kFirstColoring = labels ? "label" : "radius";
let coloring = colorings[kFirstColoring];
// Without a scale of numbers.
const tellsApart = () => coloring === colorings.branch || coloring === colorings.label;

class Span {
  least = Infinity;
  most = -Infinity;
  add(numbers) {
    for (const v of numbers) {
      if (!Number.isFinite(v)) continue;
      if (v < this.least) this.least = v;
      if (v > this.most) this.most = v;
    }
    return this;
  }
}
for (const c of Object.values(colorings)) {
  c.range = new Span();
  if (c.ofEdge) c.range.add(result.edges.map(c.ofEdge));
}
colorings.radius.range.add(result.nodes.map((n) => n.radius));
for (const e of result.edges) colorings.radius.range.add(e.radii);

function rampColor(value, { least, most }) {
  const part = most > least ? Math.min(1, (value - least) / (most - least)) : 0.5;
  const place = part * (theme.ramp.length - 1);
  const stop = Math.min(Math.floor(place), theme.ramp.length - 2);
  return new THREE.Color(theme.ramp[stop]).lerp(new THREE.Color(theme.ramp[stop + 1]),
                                                place - stop);
}
// Consecutive numbers get distant hues.
const partColor = (number, lightness) =>
  new THREE.Color().setHSL((number * 0.618034) % 1, 0.68, lightness);
function edgeColor(id) {
  if (tellsApart()) {
    return partColor(coloring === colorings.branch ? shown.branchOf(id) : edgePart(id),
                     theme.lightness);
  }
  const value = coloring.ofEdge(result.edges[id]);
  return Number.isFinite(value) ? rampColor(value, coloring.range)
                                : new THREE.Color(theme.junction);
}
