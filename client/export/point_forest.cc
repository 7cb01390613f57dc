#include "client/export/point_forest.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace bccskel::exporting {
namespace {

class Planting {
 public:
  Planting(const SkeletonGraph& graph, const TreeOrder& order, const CurveSampling& sampling,
           const std::stop_token& stop)
      : graph_(graph),
        order_(order),
        sampling_(sampling),
        stop_(stop),
        edges_at_(graph.nodes.size()),
        places_(graph.nodes.size()) {
    for (uint32_t e = 0; e < graph.edges.size(); ++e) {
      const SkeletonEdge& edge = graph.edges[e];
      edges_at_[edge.source].push_back({e, Side::kSource});
      edges_at_[edge.target].push_back({e, Side::kTarget});
    }
  }

  PointForest Run() && {
    for (const uint32_t root : order_.roots) {
      AddNode(root, std::nullopt);
      Grow(root);
      ++forest_.trees;
    }
    forest_.loops_cut = order_.loops_cut;
    return std::move(forest_);
  }

 private:
  enum class Side : uint8_t { kSource, kTarget };
  // An edge as seen from one of its nodes.
  struct Start {
    uint32_t edge;
    Side side;
  };

  // Follows each branch to its end before the next one.
  void Grow(uint32_t root) {
    std::vector<Start> open;
    const auto open_at = [&](uint32_t node) {
      const std::vector<Start>& starts = edges_at_[node];
      std::copy_if(starts.rbegin(), starts.rend(), std::back_inserter(open),
                   [&](const Start& start) { return Leaves(start, node); });
    };
    open_at(root);
    while (!open.empty() && !stop_.stop_requested()) {
      const Start start = open.back();
      open.pop_back();
      const std::optional<uint32_t> reached = AddBranch(start);
      if (reached.has_value()) open_at(*reached);
    }
  }

  // Whether to draw the edge from this node. One that closes a loop is drawn from both.
  bool Leaves(const Start& start, uint32_t node) const {
    const EdgeOrder& order = order_.edges[start.edge];
    return order.ClosesLoop() || order.proximal == node;
  }

  // Returns the node that the branch ends at.
  std::optional<uint32_t> AddBranch(const Start& start) {
    const SkeletonEdge& edge = graph_.edges[start.edge];
    std::vector<CurvePoint> curve = SampledCurve(graph_, edge, sampling_);
    uint32_t node = edge.source, other = edge.target;
    const bool closes_loop = order_.edges[start.edge].ClosesLoop();
    size_t end =
        closes_loop ? StepsOfSource(edge, curve) + 1 : std::max<size_t>(curve.size(), 1) - 1;
    if (start.side == Side::kTarget) {
      std::ranges::reverse(curve);
      std::swap(node, other);
      if (closes_loop) end = std::max(curve.size(), end) - end;
    }
    size_t parent = places_[node];
    for (size_t n = 1; n < end; ++n) {
      forest_.points.push_back({curve[n].at, curve[n].radius, parent, std::nullopt});
      parent = forest_.points.size() - 1;
    }
    if (closes_loop) return std::nullopt;
    AddNode(other, parent);
    return other;
  }

  // The number of inner points that belong to the source's side of an edge that closes a loop.
  size_t StepsOfSource(const SkeletonEdge& edge, const std::vector<CurvePoint>& curve) const {
    const std::vector<double> ways = WaysAlong(curve);
    const double from_source = order_.nodes[edge.source].root_distance;
    const double from_target = order_.nodes[edge.target].root_distance + ways.back();
    size_t n = 0;
    while (n + 2 < curve.size() && from_source + ways[n + 1] <= from_target - ways[n + 1]) ++n;
    return n;
  }

  void AddNode(uint32_t node, std::optional<size_t> parent) {
    places_[node] = forest_.points.size();
    const SkeletonNode& of = graph_.nodes[node];
    WorldPoint at = graph_.PositionOf(of.at);
    // The only kind of node that a smooth curve moves.
    if (of.kind == NodeKind::kLoop && !edges_at_[node].empty()) {
      at = SampledCurve(graph_, graph_.edges[edges_at_[node].front().edge], sampling_).front().at;
    }
    forest_.points.push_back({at, graph_.RadiusOf(of.at), parent, node});
  }

  const SkeletonGraph& graph_;
  const TreeOrder& order_;
  const CurveSampling sampling_;
  const std::stop_token& stop_;
  std::vector<std::vector<Start>> edges_at_;  // by node; a self-loop twice
  std::vector<size_t> places_;                // by node: index in the forest
  PointForest forest_;
};

}  // namespace

PointForest PointForestOf(const SkeletonGraph& graph, const TreeOrder& order,
                          const CurveSampling& sampling, const std::stop_token& stop) {
  return Planting(graph, order, sampling, stop).Run();
}

}  // namespace bccskel::exporting
