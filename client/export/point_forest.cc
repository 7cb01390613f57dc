#include "client/export/point_forest.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace bccskel::exporting {
namespace {

// Steps between points; `Neighbors(a)` are in increasing order.
class StepGraph {
 public:
  explicit StepGraph(const SkeletonGraph& graph) {
    for (const SkeletonNode& node : graph.nodes) points_.push_back(node.at);
    points_.insert(points_.end(), graph.points.begin(), graph.points.end());
    std::ranges::sort(points_);
    // std::ranges::unique does not compile with clang 14 and this standard library.
    const auto same_point = [](const SkeletonPoint& a, const SkeletonPoint& b) {
      return a.point == b.point;
    };
    points_.erase(std::unique(points_.begin(), points_.end(), same_point), points_.end());
    neighbors_.resize(points_.size());
    for (const SkeletonEdge& edge : graph.edges) AddSteps(graph.PointsOf(edge));
    for (std::vector<size_t>& list : neighbors_) {
      std::ranges::sort(list);
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
  }

  const std::vector<SkeletonPoint>& points() const { return points_; }
  const std::vector<size_t>& Neighbors(size_t n) const { return neighbors_[n]; }

  // Needs: one of the points.
  size_t PositionOf(LatticePoint p) const {
    const auto found = std::ranges::lower_bound(points_, p, {}, &SkeletonPoint::point);
    return static_cast<size_t>(found - points_.begin());
  }

 private:
  void AddSteps(std::span<const SkeletonPoint> path) {
    for (size_t n = 1; n < path.size(); ++n) {
      const size_t a = PositionOf(path[n - 1].point), b = PositionOf(path[n].point);
      if (a == b) continue;
      neighbors_[a].push_back(b);
      neighbors_[b].push_back(a);
    }
  }

  std::vector<SkeletonPoint> points_;
  std::vector<std::vector<size_t>> neighbors_;
};

constexpr size_t kNoParent = std::numeric_limits<size_t>::max();

// Shortest ways from the roots, Dijkstra's algorithm; on ties the smaller parent is taken, so the
// trees do not depend on the queue's inner order.
class ShortestWays {
 public:
  ShortestWays(const StepGraph& steps, const Placement& placement)
      : steps_(steps),
        placement_(placement),
        way_(steps.points().size(), std::numeric_limits<double>::infinity()),
        parent_(steps.points().size(), kNoParent) {}

  bool Reached(size_t n) const { return way_[n] != std::numeric_limits<double>::infinity(); }
  size_t ParentOf(size_t n) const { return parent_[n]; }

  void GrowFrom(size_t root) {
    way_[root] = 0;
    queue_.push({0, root});
    while (!queue_.empty()) {
      const auto [way, n] = queue_.top();
      queue_.pop();
      if (way > way_[n]) continue;
      for (size_t next : steps_.Neighbors(n)) Offer(next, n);
    }
  }

 private:
  double StepLength(size_t a, size_t b) const {
    const WorldPoint p = placement_.ToWorld(steps_.points()[a].point);
    const WorldPoint q = placement_.ToWorld(steps_.points()[b].point);
    const double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
    return std::sqrt(x * x + y * y + z * z);
  }

  void Offer(size_t n, size_t parent) {
    const double way = way_[parent] + StepLength(parent, n);
    if (way < way_[n]) {
      way_[n] = way;
      parent_[n] = parent;
      queue_.push({way, n});
    } else if (way == way_[n] && parent_[n] != kNoParent && parent < parent_[n]) {
      parent_[n] = parent;
    }
  }

  using Entry = std::pair<double, size_t>;
  const StepGraph& steps_;
  const Placement& placement_;
  std::vector<double> way_;
  std::vector<size_t> parent_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

std::vector<size_t> DeepestFirst(const std::vector<SkeletonPoint>& points) {
  std::vector<size_t> order(points.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, std::greater<>{}, [&](size_t n) { return points[n].radius; });
  return order;
}

// Appends the tree below `root`, each branch to its end before the next one begins.
void AppendTree(const StepGraph& steps, const ShortestWays& ways, size_t root,
                PointForest& forest) {
  std::vector<std::pair<size_t, std::optional<size_t>>> open = {{root, std::nullopt}};
  while (!open.empty()) {
    const auto [n, parent] = open.back();
    open.pop_back();
    const size_t position = forest.points.size();
    forest.points.push_back(steps.points()[n]);
    forest.parents.push_back(parent);
    const std::vector<size_t>& neighbors = steps.Neighbors(n);
    for (auto next = neighbors.rbegin(); next != neighbors.rend(); ++next) {
      if (ways.ParentOf(*next) == n) open.push_back({*next, position});
    }
  }
}

}  // namespace

PointForest PointForestOf(const SkeletonGraph& graph, std::span<const LatticePoint> roots) {
  const StepGraph steps(graph);
  ShortestWays ways(steps, graph.placement);
  PointForest forest;
  const auto grow_from = [&](size_t root) {
    if (ways.Reached(root)) return;
    ways.GrowFrom(root);
    AppendTree(steps, ways, root, forest);
    ++forest.trees;
  };
  for (LatticePoint root : roots) grow_from(steps.PositionOf(root));
  for (size_t root : DeepestFirst(steps.points())) grow_from(root);
  forest.loops_cut = graph.edges.size() + forest.trees - graph.nodes.size();
  return forest;
}

}  // namespace bccskel::exporting
