// ---- Order of pruning ----

const levelOf = Float64Array.from(result.edges, (e) => e.pruning_level ?? Infinity);
// The branches that are pruned last come first, so that the visible ones are always a prefix.
const byLevel = result.edges.map((_, id) => id)
  .sort((a, b) => levelOf[b] > levelOf[a] ? 1 : levelOf[b] < levelOf[a] ? -1 : a - b);

const partAt = (node) => partOf(nodeAt[node]);
const edgePart = (id) => partAt(result.edges[id].source);
const hidden = new Set();  // parts
let order = byLevel;  // without hidden parts

// ---- Graphs ----

// The result's own items come first, then those that pruning creates. Each step of the slider is
// the difference from the previous one.
const { steps } = pruning;
const levels = steps.map(({ level }) => level);
const nodeAt = [...result.nodes, ...pruning.nodes];
const stateAt = [...result.nodes.map(({ kind }, n) => [n, kind]), ...pruning.states];
const branchAt = [...result.edges.map(ownBranch), ...pruning.branches];
branchAt.forEach(measureBranch);

function ownBranch(e, id) {
  const { least, most } = new Span().add(e.radii);
  const sum = e.radii.reduce((a, b) => a + b, 0);
  return { source: e.source, target: e.target, length: e.length, min: least, max: most,
           mean: e.mean_radius ?? sum / e.radii.length, level: e.pruning_level, edges: [id] };
}
// The other figures of the branch table (client/export/graph_formats.h).
function measureBranch(branch, number) {
  const { source, target, edges, shared } = branch;
  const [p, q] = [nodeAt[source].position, nodeAt[target].position];
  const straight = Math.hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]);
  const figures = (name) => edges.map((id) => result.edges[id][name]).filter(Number.isFinite);
  const least = (numbers) => numbers.length ? Math.min(...numbers) : undefined;
  const most = (numbers) => numbers.length ? Math.max(...numbers) : undefined;
  Object.assign(branch, {
    id: shared ? number : edges[0], component: nodeAt[source].component ?? 0,
    part: partAt(source), label: labels && Number(partName(partAt(source))), straight,
    tortuosity: straight > 0 ? branch.length / straight : undefined,
    generation: least(figures("generation")), strahler: most(figures("strahler")) });
}

// What remains after a run with a threshold just above the level of the step.
function prunedTo(step) {
  const states = new Set(result.nodes.keys()), rows = new Set(result.edges.keys());
  for (const { states: kinds, branches } of steps.slice(0, step)) {
    for (const [set, { on, off }] of [[states, kinds], [rows, branches]]) {
      for (const item of off) set.delete(item);
      for (const item of on) set.add(item);
    }
  }
  const kindAt = new Map([...states].map((state) => stateAt[state])), degree = new Map();
  const branches = new Map(), branchOf = new Map();
  for (const row of [...rows].sort((a, b) => a - b)) {
    const branch = branchAt[row], [kind, other] = [kindAt.get(branch.source), kindAt.get(branch.target)];
    const ends = (kind === "end" ? 1 : 0) + (other === "end" ? 1 : 0), loop = kind === "loop";
    for (const n of [branch.source, branch.target]) degree.set(n, (degree.get(n) ?? 0) + 1);
    branch.type = loop ? 3 : 2 - ends;
    branch.kinds = loop ? "loop" : `${words(kind)} \u2013 ${words(other)}`;
    branches.set(branch.id, branch);
    if (!branch.shared) for (const id of branch.edges) branchOf.set(id, branch.id);
  }
  const threshold = step === 0 ? -Infinity : levels[step - 1];
  const gone = levelOf.reduce((count, level) => count + (level <= threshold ? 1 : 0), 0);
  return withoutHidden({ step, threshold, gone, nodes: [...kindAt.keys()].sort((a, b) => a - b),
                         degree, kindOf: (n) => kindAt.get(n), branches,
                         branchOf: (id) => branchOf.get(id) ?? id });
}

// Totals of every part, also of labels whose skeletons are empty, and of the visible graph.
function withoutHidden(graph) {
  const parts = [];
  const totalsOf = (id) => parts[id] ??=
    { id, label: Number(partName(id)), branches: 0, nodes: 0, length: 0 };
  labels?.names.forEach((_, label) => totalsOf(label));
  for (const n of graph.nodes) {
    const totals = totalsOf(partAt(n));
    ++totals.nodes;
    totals.max = Math.max(totals.max ?? 0, nodeAt[n].radius);
  }
  for (const branch of graph.branches.values()) {
    const totals = totalsOf(branch.part);
    ++totals.branches;
    totals.length += branch.length;
    totals.max = Math.max(totals.max, branch.max);
    if (hidden.has(branch.part)) graph.branches.delete(branch.id);
  }
  graph.parts = parts.filter(Boolean);
  graph.nodes = graph.nodes.filter((n) => !hidden.has(partAt(n)));
  const firstGone = order.findIndex((id) => levelOf[id] <= graph.threshold);
  graph.edges = firstGone < 0 ? order.length : firstGone;
  graph.length = 0;
  for (const { length } of graph.branches.values()) graph.length += length;
  return graph;
}

let shown = prunedTo(0);
// The visible branch that contains an edge.
const branchWith = (id) => shown.branches.get(shown.branchOf(id));
