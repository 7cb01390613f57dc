// ---- Order of pruning ----

const levelOf = (e) => e.pruning_level ?? Infinity;
const levels = [...new Set(result.edges.map(levelOf))].filter(Number.isFinite)
  .sort((a, b) => a - b);
// The branches that go last come first, so that those shown are always the first ones.
const byLevel = result.edges.map((_, id) => id)
  .sort((a, b) => levelOf(result.edges[b]) - levelOf(result.edges[a]) || a - b);

const componentOf = (node) => result.nodes[node].component ?? 0;
const edgeComponent = (id) => componentOf(result.edges[id].source);
const hidden = new Set();  // components
let order = byLevel;  // without the hidden ones

// ---- Figures of edges ----

const sums = new Float64Array(result.edges.length);  // of radii
const radiusRanges = result.edges.map((e, id) => {
  for (const r of e.radii) sums[id] += r;
  return new Span().add(e.radii);
});
const nodeDistance = (a, b) => {
  const [p, q] = [result.nodes[a].position, result.nodes[b].position];
  return Math.hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]);
};
const least = (numbers) => numbers.reduce((a, b) => Math.min(a, b), Infinity);
const most = (numbers) => numbers.reduce((a, b) => Math.max(a, b), -Infinity);
const finite = (v) => Number.isFinite(v) ? v : undefined;

// ---- Branches ----

// What is left when the first `step` levels are pruned, as another run with that threshold would
// count it: a junction that two branches are left of is none any more.
function prunedTo(step) {
  const threshold = step === 0 ? -Infinity : levels[step - 1];
  const degree = new Uint32Array(result.nodes.length);
  const firstGone = byLevel.findIndex((id) => levelOf(result.edges[id]) <= threshold);
  const left = firstGone < 0 ? byLevel : byLevel.slice(0, firstGone);
  for (const id of left) {
    ++degree[result.edges[id].source];
    ++degree[result.edges[id].target];
  }
  const stays = ({ kind }, n) => kind === "isolated" || kind === "closed_surface" ||
    (degree[n] > 0 && !(step > 0 && kind === "junction" && degree[n] === 2));
  const isNode = Uint8Array.from(result.nodes, (node, n) => stays(node, n) ? 1 : 0);
  const { branches, branchOf } = branchesOf(left, isNode);
  // A curve that closes where no node is left has one that stands for it.
  const loops = new Set();
  for (const branch of branches.values()) {
    if (branch.ends.length > 0) continue;
    const node = result.edges[branch.id].source;
    branch.ends = [node, node];
    loops.add(node);
    isNode[node] = 1;
  }
  const kindOf = (n) => {
    const { kind } = result.nodes[n];
    if (kind !== "junction") return kind;
    return loops.has(n) ? "loop" : degree[n] === 1 ? "end" : kind;
  };
  for (const branch of branches.values()) measureBranch(branch, kindOf, isNode);
  const nodes = [];
  isNode.forEach((is, n) => { if (is) nodes.push(n); });
  return withoutHidden({ step, nodes, degree, kindOf, branches, branchOf, threshold });
}

// Edges that meet in a node that is none any more are one branch.
// Returns: `branchOf`, by edge, the first edge of its branch; `branches`, by first edge.
function branchesOf(ids, isNode) {
  const next = Uint32Array.from(result.edges.keys());
  const firstOf = (id) => {
    while (next[id] !== id) id = next[id] = next[next[id]];
    return id;
  };
  const edgeAt = new Map();
  for (const id of ids) {
    for (const n of [result.edges[id].source, result.edges[id].target]) {
      if (isNode[n]) continue;
      const [a, b] = [firstOf(edgeAt.get(n) ?? id), firstOf(id)];
      next[Math.max(a, b)] = Math.min(a, b);
      edgeAt.set(n, id);
    }
  }
  const branches = new Map();
  for (const id of [...ids].sort((a, b) => a - b)) {
    const e = result.edges[id], first = firstOf(id);
    if (!branches.has(first)) branches.set(first, { id: first, edges: [], ends: [] });
    const branch = branches.get(first);
    branch.edges.push(id);
    branch.ends.push(...[e.source, e.target].filter((n) => isNode[n]));
  }
  return { branches, branchOf: firstOf };
}

// The figures of the branch table (client/export/branch_table.h).
function measureBranch(branch, kindOf, isNode) {
  const edges = branch.edges.map((id) => result.edges[id]), [first] = edges;
  const [source, target] = branch.ends, kinds = branch.ends.map(kindOf);
  const ends = kinds.filter((kind) => kind === "end").length, whole = edges.length === 1;
  const length = edges.reduce((sum, e) => sum + e.length, 0);
  const straight = nodeDistance(source, target);
  Object.assign(branch, {
    component: componentOf(source), source, target, length, straight,
    type: kinds[0] === "loop" ? 3 : ends === 2 ? 0 : ends === 1 ? 1 : 2,
    kinds: kinds[0] === "loop" ? "loop" : kinds.map(words).join(" \u2013 "),
    tortuosity: whole ? first.tortuosity : straight > 0 ? length / straight : undefined,
    mean: (whole && first.mean_radius) || meanRadius(branch, isNode),
    min: least(branch.edges.map((id) => radiusRanges[id].least)),
    max: most(branch.edges.map((id) => radiusRanges[id].most)),
    level: finite(least(edges.map(levelOf))),
    generation: finite(least(edges.map((e) => e.generation ?? Infinity))),
    strahler: finite(most(edges.map((e) => e.strahler ?? -Infinity))),
  });
}
// Two edges that meet inside a branch have a point in common, which counts half for each.
function meanRadius(branch, isNode) {
  let sum = 0, points = 0;
  for (const id of branch.edges) {
    const { source, target, radii } = result.edges[id];
    sum += sums[id];
    points += radii.length;
    for (const [n, radius] of [[source, radii[0]], [target, radii[radii.length - 1]]]) {
      if (isNode[n]) continue;
      sum -= radius / 2;
      points -= 0.5;
    }
  }
  return sum / points;
}

// Totals of every component, and of the graph what is not hidden.
function withoutHidden(graph) {
  const components = [];
  const totalsOf = (id) => components[id] ??=
    { id, branches: 0, nodes: 0, length: 0, max: -Infinity };
  for (const n of graph.nodes) {
    const totals = totalsOf(componentOf(n));
    ++totals.nodes;
    totals.max = Math.max(totals.max, result.nodes[n].radius);
  }
  for (const branch of graph.branches.values()) {
    const totals = totalsOf(branch.component);
    ++totals.branches;
    totals.length += branch.length;
    totals.max = Math.max(totals.max, branch.max);
    if (hidden.has(branch.component)) graph.branches.delete(branch.id);
  }
  graph.components = components.filter(Boolean);
  graph.nodes = graph.nodes.filter((n) => !hidden.has(componentOf(n)));
  const firstGone = order.findIndex((id) => levelOf(result.edges[id]) <= graph.threshold);
  graph.edges = firstGone < 0 ? order.length : firstGone;
  graph.length = 0;
  for (const { length } of graph.branches.values()) graph.length += length;
  return graph;
}

let shown = prunedTo(0);
// The branch that an edge is a part of, if it is shown.
const branchWith = (id) => result.edges[id] && levelOf(result.edges[id]) > shown.threshold
  ? shown.branches.get(shown.branchOf(id)) : undefined;
