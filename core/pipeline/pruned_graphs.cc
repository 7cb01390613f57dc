#include "core/pipeline/pruned_graphs.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "core/exec/status_macros.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/point_table.h"
#include "core/pruning/simple_points.h"
#include "core/pruning/thin_set.h"
#include "core/skeleton/junction_merger.h"

namespace bccskel {
namespace {

constexpr size_t kLevelsAlwaysVisited = 10;

struct KnownPoint {
  SkeletonPoint point;
  double level = kNoLevel;  // the largest of the edges through it
};
using KnownPoints = PointTable<KnownPoint>;

KnownPoints PointsOf(const SkeletonGraph& graph) {
  KnownPoints known;
  known.Reserve(graph.points.size() + graph.sheets.size());
  for (const SkeletonEdge& edge : graph.edges) {
    const std::span<const SkeletonPoint> points = graph.PointsOf(edge);
    for (const SkeletonPoint& p : points) {
      KnownPoint* found = known.Find(p.point);
      if (found == nullptr) {
        known.Set(p.point, {p, edge.pruning_level});
      } else {
        found->level = std::max(found->level, edge.pruning_level);
      }
    }
  }
  for (const SkeletonNode& node : graph.nodes) {
    if (known.Find(node.at.point) == nullptr) known.Set(node.at.point, {node.at});
  }
  for (const SkeletonPoint& p : graph.sheets) {
    if (known.Find(p.point) == nullptr) known.Set(p.point, {p});
  }
  return known;
}

absl::StatusOr<ThinSkeleton> SkeletonOf(const KnownPoints& known, const Placement& placement) {
  LatticeExtent extent{1, 1, 1};
  known.ForEach([&](LatticePoint p, const KnownPoint&) {
    extent.nx = std::max(extent.nx, p.x / 2 + 1);
    extent.ny = std::max(extent.ny, p.y / 2 + 1);
    extent.nz = std::max(extent.nz, p.z / 2 + 1);
  });
  VolumeBuilder builder(extent, placement);
  known.ForEach([&](LatticePoint p, const KnownPoint&) { builder.Add(p); });
  ThinSkeleton skeleton;
  BCCSKEL_ASSIGN_OR_RETURN(skeleton.points, std::move(builder).Build());
  skeleton.points.ForEachPoint(
      [&](LatticePoint p) { skeleton.radii.push_back(known.Find(p)->point.radius); });
  return skeleton;
}

// Removes branches with a free end, lowest levels first, in the order in which they were removed
// when levels were computed.
class LevelPruner {
 public:
  LevelPruner(const KnownPoints& known, ThinSet& set) : known_(known), set_(set) {
    for (LatticePoint end : set_.Ends()) AddTurn(end);
  }

  void PruneTo(double level) {
    while (!turns_.empty() && turns_.begin()->first <= level) {
      const LatticePoint end = turns_.begin()->second;
      turns_.erase(turns_.begin());
      if (IsEnd(end)) Remove(BranchFrom(set_, end));
    }
  }

 private:
  bool IsEnd(LatticePoint p) const { return set_.Contains(p) && set_.IsEnd(p); }

  void AddTurn(LatticePoint end) {
    double level = -1;
    for (LatticePoint p : BranchFrom(set_, end).points) {
      level = std::max(level, known_.Find(p)->level);
    }
    if (std::isfinite(level)) turns_.emplace(level, end);
  }

  void Remove(const FreeBranch& branch) {
    if (!branch.junction.has_value()) return;
    for (LatticePoint p : RemoveBranch(set_, branch, {}).around) {
      if (IsEnd(p)) AddTurn(p);
    }
  }

  const KnownPoints& known_;
  ThinSet& set_;
  std::set<std::pair<double, LatticePoint>> turns_;
};

// Ascending.
std::vector<double> LevelsToVisit(const SkeletonGraph& graph, uint64_t most_levels) {
  std::set<double> levels;
  for (const SkeletonEdge& edge : graph.edges) {
    if (std::isfinite(edge.pruning_level)) levels.insert(edge.pruning_level);
  }
  const size_t few = std::max<size_t>(most_levels, 2 * kLevelsAlwaysVisited);
  if (levels.size() <= few) return {levels.begin(), levels.end()};
  std::vector<double> all(levels.begin(), levels.end()), visited;
  const size_t low = all.size() - kLevelsAlwaysVisited, stops = few - kLevelsAlwaysVisited;
  for (size_t n = 0; n < stops; ++n) visited.push_back(all[(n + 1) * low / stops - 1]);
  visited.insert(visited.end(), all.begin() + static_cast<std::ptrdiff_t>(low), all.end());
  return visited;
}

void Restore(const KnownPoints& known, SkeletonGraph& graph) {
  const auto restore = [&](SkeletonPoint& p) { p = known.Find(p.point)->point; };
  for (SkeletonNode& node : graph.nodes) {
    restore(node.at);
    node.at.shift = {0, 0, 0};
  }
  std::ranges::for_each(graph.points, restore);
  std::ranges::for_each(graph.sheets, restore);
}

}  // namespace

absl::Status ForEachPrunedGraph(const SkeletonGraph& graph, double junction_reach,
                                uint64_t most_points, const exec::Context& context,
                                const OnPrunedGraph& visit) {
  const KnownPoints known = PointsOf(graph);
  if (known.empty()) return absl::OkStatus();
  const std::vector<double> levels = LevelsToVisit(graph, most_points / known.size());
  if (levels.empty()) return absl::OkStatus();
  BCCSKEL_ASSIGN_OR_RETURN(const ThinSkeleton whole, SkeletonOf(known, graph.placement));
  ThinSet set(whole, context);
  LevelPruner pruner(known, set);
  for (const double level : levels) {
    pruner.PruneTo(level);
    ThinSkeleton thin = set.ToSkeleton(whole);
    thin.points.ForEachPoint([&](LatticePoint p) {
      const bool at_junction = set.Branches(p);
      thin.levels.push_back(at_junction ? kNoLevel : known.Find(p)->level);
    });
    BCCSKEL_ASSIGN_OR_RETURN(SkeletonGraph pruned, TraceSkeleton(thin, context));
    BCCSKEL_RETURN_IF_ERROR(MergeJunctions(junction_reach, context, pruned));
    Restore(known, pruned);
    visit(level, pruned);
  }
  return absl::OkStatus();
}

}  // namespace bccskel
