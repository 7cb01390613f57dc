#include "client/view/pruning_steps.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "absl/strings/numbers.h"
#include "client/view/result_graph.h"
#include "core/pipeline/pruned_graphs.h"
#include "core/pruning/point_table.h"
#include "core/skeleton/junction_merger.h"

namespace bccskel::view {
namespace {

// Tracing takes about a microsecond per point.
constexpr uint64_t kMostTracedPoints = 4'000'000;

using Path = std::vector<LatticePoint>;

Path PathOf(const SkeletonGraph& graph, const SkeletonEdge& edge) {
  Path path;
  for (const SkeletonPoint& p : graph.PointsOf(edge)) path.push_back(p.point);
  return path;
}

// The edges that run through each point.
class PointOwners {
 public:
  explicit PointOwners(const SkeletonGraph& graph) {
    owners_.Reserve(graph.points.size());
    for (uint32_t e = 0; e < graph.edges.size(); ++e) {
      for (const SkeletonPoint& p : graph.PointsOf(graph.edges[e])) Add(p.point, e);
    }
  }

  // The first edge through the point.
  std::optional<uint32_t> FirstAt(LatticePoint p) const {
    const Owner* found = owners_.Find(p);
    return found == nullptr ? std::nullopt : std::optional(found->first);
  }
  // The only edge through the point, if there is exactly one.
  std::optional<uint32_t> OnlyAt(LatticePoint p) const {
    const Owner* found = owners_.Find(p);
    return found == nullptr || found->shared ? std::nullopt : std::optional(found->first);
  }

 private:
  struct Owner {
    uint32_t first;
    bool shared;
  };

  void Add(LatticePoint p, uint32_t edge) {
    Owner* found = owners_.Find(p);
    if (found == nullptr) {
      owners_.Set(p, {edge, false});
    } else {
      found->shared = found->shared || found->first != edge;
    }
  }

  PointTable<Owner> owners_;
};

class Collector {
 public:
  explicit Collector(const SkeletonGraph& base)
      : base_(base), owners_(base), components_(ComponentsOf(base).of_node) {
    for (uint32_t n = 0; n < base.nodes.size(); ++n) {
      nodes_.emplace(base.nodes[n].at.point, n);
      states_.emplace(NodeState{n, base.nodes[n].kind}, n);
      states_now_.push_back(n);
    }
    for (uint32_t e = 0; e < base.edges.size(); ++e) {
      branches_.emplace(PathOf(base, base.edges[e]), e);
      branches_now_.push_back(e);
    }
  }

  void Add(double level, const SkeletonGraph& graph) {
    std::vector<uint32_t> states, branches, nodes;
    for (const SkeletonNode& node : graph.nodes) {
      nodes.push_back(NodeOf(graph, node));
      states.push_back(StateOf({nodes.back(), node.kind}));
    }
    const PointOwners owners(graph);
    for (const SkeletonEdge& edge : graph.edges) {
      branches.push_back(BranchOf(graph, edge, owners, nodes));
    }
    steps_.steps.push_back({level, ChangeTo(std::move(states), states_now_),
                            ChangeTo(std::move(branches), branches_now_)});
  }

  PruningSteps Take() && { return std::move(steps_); }

 private:
  uint32_t NodeOf(const SkeletonGraph& graph, const SkeletonNode& node) {
    const auto [at, is_new] = nodes_.emplace(node.at.point, static_cast<uint32_t>(nodes_.size()));
    if (is_new) {
      const SkeletonEdge& through = base_.edges[FirstEdgeOf({node.at.point})];
      steps_.nodes.push_back(
          {graph.PositionOf(node.at), graph.RadiusOf(node.at), components_[through.source]});
    }
    return at->second;
  }

  uint32_t StateOf(const NodeState& state) {
    const auto [at, is_new] = states_.emplace(state, static_cast<uint32_t>(states_.size()));
    if (is_new) steps_.states.push_back(state);
    return at->second;
  }

  uint32_t BranchOf(const SkeletonGraph& graph, const SkeletonEdge& edge, const PointOwners& owners,
                    const std::vector<uint32_t>& nodes) {
    const auto [at, is_new] =
        branches_.emplace(PathOf(graph, edge), static_cast<uint32_t>(branches_.size()));
    if (is_new) {
      PrunedBranch branch = {nodes[edge.source],
                             nodes[edge.target],
                             FiguresOf(graph, edge),
                             edge.pruning_level,
                             {},
                             false};
      FindEdges(at->first, owners, branch);
      steps_.branches.push_back(std::move(branch));
    }
    return at->second;
  }

  void FindEdges(const Path& path, const PointOwners& owners, PrunedBranch& branch) const {
    for (LatticePoint p : path) {
      const std::optional<uint32_t> edge = owners_.OnlyAt(p);
      if (edge.has_value() && owners.OnlyAt(p).has_value()) branch.edges.push_back(*edge);
    }
    std::ranges::sort(branch.edges);
    branch.edges.erase(std::unique(branch.edges.begin(), branch.edges.end()), branch.edges.end());
    if (!branch.edges.empty()) return;
    branch.shared = true;
    branch.edges = {FirstEdgeOf(path)};
  }

  // The first edge of the result through any of the points. Sheets that pruning turns into curves
  // have none: they are shown with the first edge.
  uint32_t FirstEdgeOf(const Path& path) const {
    for (size_t n = 0; n < path.size(); ++n) {
      const auto edge = owners_.FirstAt(path[(n + path.size() / 2) % path.size()]);
      if (edge.has_value()) return *edge;
    }
    return 0;
  }

  static Change ChangeTo(std::vector<uint32_t> next, std::vector<uint32_t>& now) {
    Change change;
    std::ranges::sort(next);
    std::ranges::set_difference(next, now, std::back_inserter(change.on));
    std::ranges::set_difference(now, next, std::back_inserter(change.off));
    now = std::move(next);
    return change;
  }

  const SkeletonGraph& base_;
  const PointOwners owners_;
  const std::vector<uint32_t> components_;  // by node of the base
  std::map<LatticePoint, uint32_t> nodes_;
  std::map<NodeState, uint32_t> states_;
  std::map<Path, uint32_t> branches_;
  std::vector<uint32_t> states_now_;    // ascending
  std::vector<uint32_t> branches_now_;  // ascending
  PruningSteps steps_;
};

double JunctionReachOf(const ResultGraph& result) {
  double reach = kDefaultJunctionReach;
  for (const auto& [name, value] : result.options) {
    if (name == "merge_junctions" && !absl::SimpleAtod(value, &reach)) return 0;
  }
  return reach;
}

}  // namespace

PruningSteps PruningStepsOf(const ResultDocument& document, const exec::Context& context) {
  const bool has_levels = std::ranges::any_of(
      document.edges, [](const auto& edge) { return std::isfinite(edge.pruning_level); });
  if (!has_levels) return {};
  const absl::StatusOr<ResultGraph> result = ResultGraphOf(document, context.stop);
  if (!result.ok()) return {};
  Collector collector(result->graph);
  const absl::Status done = ForEachPrunedGraph(
      result->graph, JunctionReachOf(*result), kMostTracedPoints, context,
      [&](double level, const SkeletonGraph& graph) { collector.Add(level, graph); });
  return done.ok() ? std::move(collector).Take() : PruningSteps();
}

}  // namespace bccskel::view
