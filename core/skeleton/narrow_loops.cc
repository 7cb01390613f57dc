#include "core/skeleton/narrow_loops.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <span>
#include <vector>

#include "core/distance/places.h"
#include "core/exec/union_find.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel {
namespace {

constexpr size_t kMostLoops = 10'000;
constexpr size_t kMostNodes = 32;  // visited for an edge
constexpr size_t kMostEdges = 16;  // followed from a node
constexpr size_t kBalls = 64;      // of a loop that count
constexpr double kFits = 0.85;     // of a diameter: balls of thin limbs stick out of them a little
constexpr uint32_t kNoEdge = std::numeric_limits<uint32_t>::max();

struct Ball {
  WorldPoint center;
  double radius = 0;
};

double ClearanceOf(const WorldPoint& at, std::span<const Ball> balls) {
  double clearance = std::numeric_limits<double>::infinity();
  for (const Ball& ball : balls) {
    clearance = std::min(clearance, DistanceBetween(at, ball.center) - ball.radius);
  }
  return clearance;
}

// Whether a ball of this diameter fits between these, which lie around a loop.
bool FitsBetween(std::span<const Ball> loop, double diameter) {
  for (size_t n = 0; n < loop.size() / 2; ++n) {
    const Ball &a = loop[n], &b = loop[n + loop.size() / 2];
    const double apart = DistanceBetween(a.center, b.center);
    if (apart == 0) continue;
    const double share = std::clamp((1 + (a.radius - b.radius) / apart) / 2, 0.0, 1.0);
    WorldPoint middle;  // of the gap
    for (size_t axis = 0; axis < 3; ++axis) {
      middle[axis] = std::lerp(a.center[axis], b.center[axis], share);
    }
    if (ClearanceOf(middle, loop) >= kFits * diameter / 2) return true;
  }
  return false;
}

class LoopCounter {
 public:
  LoopCounter(const SkeletonGraph& graph, double width)
      : graph_(graph), width_(width), joined_(graph.nodes.size()), edges_at_(graph.nodes.size()) {
    const AxisScale scale = AxisScaleOf(graph.placement);
    for (const SkeletonEdge& edge : graph.edges) {
      const std::span<const SkeletonPoint> points = graph.PointsOf(edge);
      double& length = lengths_.emplace_back(0);
      for (size_t n = 1; n < points.size(); ++n) {
        length += StraightDistance(points[n - 1].point, points[n].point, scale);
      }
    }
  }

  uint64_t Count() {
    std::vector<uint32_t> order(graph_.edges.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](uint32_t n) { return lengths_[n]; });
    uint64_t narrow = 0, loops = 0;
    for (const uint32_t n : order) {
      const SkeletonEdge& edge = graph_.edges[n];
      if (joined_.Find(edge.source) == joined_.Find(edge.target)) {
        if (++loops > kMostLoops) break;
        const std::vector<uint32_t> loop = LoopOver(n);
        if (!loop.empty() && !FitsBetween(BallsOf(loop), width_)) ++narrow;
      }
      joined_.Unite(edge.source, edge.target);
      edges_at_[edge.source].push_back(n);
      if (edge.target != edge.source) edges_at_[edge.target].push_back(n);
    }
    return narrow;
  }

 private:
  // A way along edges.
  struct Way {
    double length = 0;
    uint32_t to = 0;          // node
    uint32_t last = kNoEdge;  // edge
    size_t before = 0;        // of the ways found, the one that this one continues

    bool operator>(const Way& other) const { return length > other.length; }
  };

  // The edges of the shortest loop over this one and those added before, in order; none if there is
  // no loop.
  std::vector<uint32_t> LoopOver(uint32_t edge) const {
    const uint32_t from = graph_.edges[edge].source, to = graph_.edges[edge].target;
    std::priority_queue<Way, std::vector<Way>, std::greater<>> next;
    next.push({.to = from});
    std::vector<Way> found;
    while (!next.empty() && found.size() < kMostNodes) {
      const Way way = next.top();
      next.pop();
      if (std::ranges::find(found, way.to, &Way::to) != found.end()) continue;
      found.push_back(way);
      if (way.to == to) return EdgesOf(found, edge);
      const std::span<const uint32_t> edges = edges_at_[way.to];
      for (const uint32_t other : edges.first(std::min(edges.size(), kMostEdges))) {
        const SkeletonEdge& e = graph_.edges[other];
        const uint32_t end = e.source == way.to ? e.target : e.source;
        next.push({way.length + lengths_[other], end, other, found.size() - 1});
      }
    }
    return {};
  }

  static std::vector<uint32_t> EdgesOf(std::span<const Way> found, uint32_t closing) {
    std::vector<uint32_t> edges = {closing};
    for (size_t n = found.size() - 1; found[n].last != kNoEdge; n = found[n].before) {
      edges.push_back(found[n].last);
    }
    return edges;
  }

  // Evenly spaced.
  std::vector<Ball> BallsOf(std::span<const uint32_t> edges) const {
    std::vector<Ball> all, some;
    uint32_t at = graph_.edges[edges[0]].source;
    for (const uint32_t n : edges) {
      const SkeletonEdge& edge = graph_.edges[n];
      const std::span<const SkeletonPoint> points = graph_.PointsOf(edge);
      const std::vector<WorldPoint> curve = SmoothCurve(graph_, edge);
      const bool forward = edge.source == at;
      for (size_t k = 0; k < points.size(); ++k) {
        const size_t i = forward ? k : points.size() - 1 - k;
        all.push_back({curve[i], graph_.RadiusOf(points[i])});
      }
      at = forward ? edge.target : edge.source;
    }
    const size_t count = std::min(all.size(), kBalls);
    for (size_t n = 0; n < count; ++n) {
      const size_t at = n * all.size() / count;
      some.push_back(all[at]);
      // Where a thin limb's curve alternates between two sides, so do its radii.
      for (const size_t beside : {at + 1, at + all.size() - 1}) {
        some.back().radius = std::min(some.back().radius, all[beside % all.size()].radius);
      }
    }
    return some;
  }

  const SkeletonGraph& graph_;
  const double width_;
  UnionFind<uint32_t> joined_;                   // nodes, by the edges added
  std::vector<double> lengths_;                  // by edge
  std::vector<std::vector<uint32_t>> edges_at_;  // by node: those added
};

}  // namespace

uint64_t CountNarrowLoops(const SkeletonGraph& graph, double width) {
  return LoopCounter(graph, width).Count();
}

}  // namespace bccskel
