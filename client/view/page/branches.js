// ---- Order of pruning ----

const levelOf = Float64Array.from(result.edges, (e) => e.pruning_level ?? Infinity);
const levels = [...new Set(levelOf)].filter(Number.isFinite).sort((a, b) => a - b);
// The branches that go last come first, so that those shown are always the first ones.
const byLevel = result.edges.map((_, id) => id)
  .sort((a, b) => levelOf[b] > levelOf[a] ? 1 : levelOf[b] < levelOf[a] ? -1 : a - b);

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

// ---- Branches ----

// What is left when the first `step` levels are pruned, as another run with that threshold would
// count it: a junction that two branches are left of is none any more.
function prunedTo(step) {
  const threshold = step === 0 ? -Infinity : levels[step - 1];
  const degree = new Uint32Array(result.nodes.length);
  const left = [...result.edges.keys()].filter((id) => levelOf[id] > threshold);
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
  return withoutHidden({ step, threshold, gone: levelOf.length - left.length, nodes, degree, kindOf,
                         branches, branchOf });
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
  for (const id of ids) {
    const e = result.edges[id], first = firstOf(id);
    let branch = branches.get(first);
    if (!branch) branches.set(first, branch = { id: first, edges: [], ends: [] });
    branch.edges.push(id);
    if (isNode[e.source]) branch.ends.push(e.source);
    if (isNode[e.target]) branch.ends.push(e.target);
  }
  return { branches, branchOf: firstOf };
}

// The figures of the branch table (client/export/branch_table.h).
function measureBranch(branch, kindOf, isNode) {
  const [source, target] = branch.ends, [kind, other] = [kindOf(source), kindOf(target)];
  const ends = (kind === "end" ? 1 : 0) + (other === "end" ? 1 : 0), loop = kind === "loop";
  Object.assign(branch, {
    component: componentOf(source), source, target,
    straight: nodeDistance(source, target), type: loop ? 3 : 2 - ends,
    kinds: loop ? "loop" : `${words(kind)} \u2013 ${words(other)}`,
    length: 0, min: Infinity, max: -Infinity, level: Infinity, generation: Infinity,
    strahler: -Infinity });
  for (const id of branch.edges) {
    const e = result.edges[id], { least, most } = radiusRanges[id];
    branch.length += e.length;
    branch.min = Math.min(branch.min, least);
    branch.max = Math.max(branch.max, most);
    branch.level = Math.min(branch.level, levelOf[id]);
    branch.generation = Math.min(branch.generation, e.generation ?? Infinity);
    branch.strahler = Math.max(branch.strahler, e.strahler ?? -Infinity);
  }
  for (const key of ["level", "generation", "strahler"]) {
    if (!Number.isFinite(branch[key])) branch[key] = undefined;
  }
  const only = branch.edges.length === 1 ? result.edges[branch.id] : null;
  branch.mean = only?.mean_radius ?? meanRadius(branch, isNode);
  branch.tortuosity = only ? only.tortuosity
    : branch.straight > 0 ? branch.length / branch.straight : undefined;
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
  const firstGone = order.findIndex((id) => levelOf[id] <= graph.threshold);
  graph.edges = firstGone < 0 ? order.length : firstGone;
  graph.length = 0;
  for (const { length } of graph.branches.values()) graph.length += length;
  return graph;
}

let shown = prunedTo(0);
// The branch that an edge is a part of, if it is shown.
const branchWith = (id) => levelOf[id] > shown.threshold
  ? shown.branches.get(shown.branchOf(id)) : undefined;
