#include "client/export/point_forest.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

struct CurvePoint {
  WorldPoint at;
  double radius;
};
using Curve = std::vector<CurvePoint>;

// Bounds what a tiny step may ask for.
constexpr double kMostPerPoint = 1000;
// Fewer would turn a loop of one edge into a point or a line there and back.
constexpr size_t kLeastStepsOfLoop = 4;

double Between(const WorldPoint& a, const WorldPoint& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

// The way along the curve to each of its points.
std::vector<double> WaysAlong(const Curve& curve) {
  std::vector<double> ways = {0};
  for (size_t n = 1; n < curve.size(); ++n) {
    ways.push_back(ways.back() + Between(curve[n - 1].at, curve[n].at));
  }
  return ways;
}

CurvePoint Mix(const CurvePoint& a, const CurvePoint& b, double part) {
  CurvePoint mixed = {a.at, a.radius + part * (b.radius - a.radius)};
  for (size_t axis = 0; axis < 3; ++axis) mixed.at[axis] += part * (b.at[axis] - a.at[axis]);
  return mixed;
}

// The same curve by `steps` steps of equal length. Needs: at least two points, a step.
Curve Resampled(const Curve& curve, size_t steps) {
  const std::vector<double> ways = WaysAlong(curve);
  Curve resampled = {curve.front()};
  size_t behind = 1;
  for (size_t n = 1; n < steps; ++n) {
    const double way = ways.back() * static_cast<double>(n) / static_cast<double>(steps);
    while (behind + 1 < curve.size() && ways[behind] < way) ++behind;
    const double length = ways[behind] - ways[behind - 1];
    const double part = length > 0 ? (way - ways[behind - 1]) / length : 0;
    resampled.push_back(Mix(curve[behind - 1], curve[behind], std::clamp(part, 0.0, 1.0)));
  }
  resampled.push_back(curve.back());
  return resampled;
}

Curve CurveOf(const SkeletonGraph& graph, const SkeletonEdge& edge, const CurveSampling& sampling) {
  const std::span<const SkeletonPoint> points = graph.PointsOf(edge);
  const bool raw = sampling.step == 0.0;
  const std::vector<WorldPoint> smooth =
      raw ? std::vector<WorldPoint>() : SmoothCurve(graph, edge);
  Curve curve;
  for (size_t n = 0; n < points.size(); ++n) {
    curve.push_back({raw ? graph.PositionOf(points[n]) : smooth[n], graph.RadiusOf(points[n])});
  }
  if (raw || !sampling.step.has_value() || curve.size() < 2) return curve;
  const double most = kMostPerPoint * static_cast<double>(curve.size());
  const double wanted = std::round(WaysAlong(curve).back() / *sampling.step);
  const size_t least = edge.source == edge.target ? kLeastStepsOfLoop : 1;
  return Resampled(curve, std::max(least, static_cast<size_t>(std::min(wanted, most))));
}

class Planting {
 public:
  Planting(const SkeletonGraph& graph, const TreeOrder& order, const CurveSampling& sampling)
      : graph_(graph),
        order_(order),
        sampling_(sampling),
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
  // An edge, seen from its node on this side.
  struct Start {
    uint32_t edge;
    Side side;
  };

  // Each branch to its end before the next one begins.
  void Grow(uint32_t root) {
    std::vector<Start> open;
    const auto open_at = [&](uint32_t node) {
      const std::vector<Start>& starts = edges_at_[node];
      std::copy_if(starts.rbegin(), starts.rend(), std::back_inserter(open),
                   [&](const Start& start) { return Leaves(start, node); });
    };
    open_at(root);
    while (!open.empty()) {
      const Start start = open.back();
      open.pop_back();
      const std::optional<uint32_t> reached = AddBranch(start);
      if (reached.has_value()) open_at(*reached);
    }
  }

  // Whether the edge is to be drawn from this node on. One that closes a loop is from both.
  bool Leaves(const Start& start, uint32_t node) const {
    const EdgeOrder& order = order_.edges[start.edge];
    return order.ClosesLoop() || order.proximal == node;
  }

  // Returns the node that the branch ends at.
  std::optional<uint32_t> AddBranch(const Start& start) {
    const SkeletonEdge& edge = graph_.edges[start.edge];
    Curve curve = CurveOf(graph_, edge, sampling_);
    uint32_t node = edge.source, other = edge.target;
    const bool closes_loop = order_.edges[start.edge].ClosesLoop();
    size_t end = closes_loop ? StepsOfSource(edge, curve) + 1 : std::max<size_t>(curve.size(), 1) - 1;
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

  // How many inner points of an edge that closes a loop go to its source.
  size_t StepsOfSource(const SkeletonEdge& edge, const Curve& curve) const {
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
    // The one kind of node that a smooth curve moves.
    if (of.kind == NodeKind::kLoop && !edges_at_[node].empty()) {
      at = CurveOf(graph_, graph_.edges[edges_at_[node].front().edge], sampling_).front().at;
    }
    forest_.points.push_back({at, graph_.RadiusOf(of.at), parent, node});
  }

  const SkeletonGraph& graph_;
  const TreeOrder& order_;
  const CurveSampling sampling_;
  std::vector<std::vector<Start>> edges_at_;  // by node; an edge to itself twice
  std::vector<size_t> places_;                // by node: in the forest
  PointForest forest_;
};

}  // namespace

PointForest PointForestOf(const SkeletonGraph& graph, const TreeOrder& order,
                          const CurveSampling& sampling) {
  return Planting(graph, order, sampling).Run();
}

}  // namespace bccskel::exporting
