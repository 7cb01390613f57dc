#include "core/pruning/sheet_pruner.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/exec/stop_poll.h"
#include "core/pruning/sheet_burning.h"
#include "core/pruning/simple_points.h"
#include "core/skeleton/branches.h"
#include "core/skeleton/clusters.h"
#include "core/skeleton/thin_points.h"
#include "core/topology/simple_point_table.h"

namespace bccskel {
namespace {

constexpr double kTwigSlope = 0.5;

// What is worth less than the margin, in the order in which it burned, each point once it is
// simple.
void RemoveInTurn(ThinSet& set, const SheetBurning& burning, double margin,
                  const exec::Context& context) {
  StopPoll poll(context);
  PointTable<size_t> place;
  std::set<std::pair<size_t, LatticePoint>> turns;
  for (size_t n = 0; n < burning.burned().size(); ++n) {
    const LatticePoint p = burning.burned()[n];
    if (burning.WorthOf(p) >= margin) continue;
    place.Set(p, n);
    turns.emplace(n, p);
  }
  while (!turns.empty() && !poll.Stopped()) {
    const LatticePoint p = turns.begin()->second;
    turns.erase(turns.begin());
    const NeighborMask neighbors = set.NeighborsOf(p);
    if (!IsSimple(neighbors)) continue;
    set.Remove(p);
    place.Remove(p);
    ForEachNeighbor(p, neighbors, [&](LatticePoint q) {
      const size_t* n = place.Find(q);
      if (n != nullptr) turns.emplace(*n, q);
    });
  }
}

// What hangs on the rest by a curve: the curve's points and the patch that it ends in, or its end.
struct Twig {
  std::vector<LatticePoint> points;
  LatticePoint foot;  // the point of the rest where the curve begins
};

class TwigFinder {
 public:
  TwigFinder(const ThinSet& set, const ThinSkeleton& grid, StopPoll& poll)
      : points_(set.ToSkeleton(grid), poll),
        clusters_(points_, poll),
        branches_(FollowBranches(points_, clusters_, poll)) {}

  std::vector<Twig> Find() const {
    std::vector<Twig> twigs;
    for (const Branch& branch : branches_.between) {
      if (HangsOn(branch.source, branch.target)) {
        twigs.push_back(TwigOf(branch.source, branch.points, branch.points.back()));
      } else if (HangsOn(branch.target, branch.source)) {
        twigs.push_back(TwigOf(branch.target, branch.points, branch.points.front()));
      }
    }
    std::ranges::sort(twigs, {}, [](const Twig& twig) { return twig.points.front(); });
    return twigs;
  }

 private:
  // A sheet and its only twig hang on each other: the smaller one is the twig.
  bool HangsOn(ClusterIndex end, ClusterIndex rest) const {
    const Cluster& cluster = clusters_[end];
    return cluster.branches == 1 && cluster.IsContractible() &&
           (clusters_[rest].branches > 1 || cluster.points.size() < clusters_[rest].points.size());
  }

  Twig TwigOf(ClusterIndex end, const PointPath& branch, PointIndex foot) const {
    Twig twig{{}, points_[foot].point};
    const auto add = [&](PointIndex p) { twig.points.push_back(points_[p].point); };
    std::ranges::for_each(clusters_[end].points, add);
    for (const PointIndex p : branch) {
      if (clusters_.IsPlainCurvePoint(p)) {
        add(p);
      } else if (clusters_[clusters_.ClusterOf(p)].IsBend()) {
        std::ranges::for_each(clusters_[clusters_.ClusterOf(p)].points, add);
      }
    }
    return twig;
  }

  ThinPoints points_;
  Clusters clusters_;
  Branches branches_;
};

// Points of the twig, each once it is simple; a tunnel of the twig stays. Returns whether any went.
bool RemoveFarthestFirst(ThinSet& set, const Twig& twig) {
  const PointSet points(twig.points.begin(), twig.points.end());
  std::set<std::pair<double, LatticePoint>> turns;
  const auto add = [&](LatticePoint p) {
    if (points.contains(p)) turns.emplace(-set.Between(p, twig.foot), p);
  };
  std::ranges::for_each(twig.points, add);
  bool any = false;
  while (!turns.empty()) {
    const LatticePoint p = turns.begin()->second;
    turns.erase(turns.begin());
    const NeighborMask neighbors = set.NeighborsOf(p);
    if (!IsSimple(neighbors)) continue;
    set.Remove(p);
    any = true;
    ForEachNeighbor(p, neighbors, add);
  }
  return any;
}

// As the slope rule for curves, with the place where the curve leaves the sheet as the junction.
// Returns whether any went.
bool RemoveTwigs(ThinSet& set, const ThinSkeleton& grid, double margin, const PointSet& keep,
                 StopPoll& poll) {
  const TwigFinder finder(set, grid, poll);
  if (poll.StoppedNow()) return false;
  bool any = false;
  for (const Twig& twig : finder.Find()) {
    const double limit = set.RadiusOf(twig.foot) + margin;
    const bool spurious = std::ranges::all_of(twig.points, [&](LatticePoint p) {
      return !keep.contains(p) && kTwigSlope * set.Between(p, twig.foot) + set.RadiusOf(p) < limit;
    });
    if (spurious) any |= RemoveFarthestFirst(set, twig);
  }
  return any;
}

}  // namespace

absl::StatusOr<ThinSkeleton> PruneSheets(const ThinSkeleton& sheets, double margin,
                                         std::span<const LatticePoint> keep,
                                         const exec::Context& context) {
  ThinSet set(sheets, context);
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  const PointSet kept(keep.begin(), keep.end());
  {
    const SheetBurning burning(set, kept, context);
    if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
    RemoveInTurn(set, burning, margin, context);
  }
  PointSet spared = kept;
  set.ForEachPoint([&](LatticePoint p) {
    if (set.BirthOf(p) > 0) spared.insert(p);
  });
  StopPoll poll(context);
  do {
    RemoveSimplePoints(set, spared);
  } while (RemoveTwigs(set, sheets, margin, kept, poll));
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  return set.ToSkeleton(sheets);
}

}  // namespace bccskel
