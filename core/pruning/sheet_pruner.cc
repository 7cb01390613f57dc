#include "core/pruning/sheet_pruner.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/distance/places.h"
#include "core/exec/stop_poll.h"
#include "core/pruning/sheet_burning.h"
#include "core/pruning/sheet_set.h"
#include "core/pruning/thin_set.h"
#include "core/skeleton/branches.h"
#include "core/skeleton/clusters.h"
#include "core/skeleton/thin_points.h"
#include "core/topology/simple_point_table.h"

namespace bccskel {
namespace {

constexpr double kTwigSlope = 0.5;

// A part that only a curve connects to the rest: the curve, and the patch or point that it ends in.
struct Twig {
  std::vector<PointIndex> points;
  PointIndex foot;  // the point of the rest where the curve begins
};

class TwigFinder {
 public:
  // Considers the points of `all` with the indices `some`, in increasing order.
  TwigFinder(const ThinPoints& all, std::vector<PointIndex> some, StopPoll& poll)
      : some_(std::move(some)),
        points_(all, some_, poll),
        clusters_(points_, poll),
        branches_(FollowBranches(points_, clusters_, poll)) {}

  // Indices are those of `all`.
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
  // Of a sheet and its only twig, either could be the twig of the other: the smaller one is.
  bool HangsOn(ClusterIndex end, ClusterIndex rest) const {
    const Cluster& cluster = clusters_[end];
    return cluster.branches == 1 && cluster.IsContractible() &&
           (clusters_[rest].branches > 1 || cluster.points.size() < clusters_[rest].points.size());
  }

  Twig TwigOf(ClusterIndex end, const PointPath& branch, PointIndex foot) const {
    Twig twig{{}, some_[foot]};
    const auto add = [&](PointIndex p) { twig.points.push_back(some_[p]); };
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

  std::vector<PointIndex> some_;
  ThinPoints points_;
  Clusters clusters_;
  Branches branches_;
};

class SheetPruner {
 public:
  SheetPruner(const ThinSkeleton& sheets, double margin, std::span<const LatticePoint> keep,
              const exec::Context& context)
      : scale_(AxisScaleOf(sheets.points.placement())),
        margin_(margin),
        poll_(context),
        points_(sheets, poll_),
        set_(points_),
        kept_(points_.size(), 0) {
    const PointSet kept(keep.begin(), keep.end());
    for (PointIndex p = 0; p < points_.size() && !kept.empty(); ++p) {
      kept_[p] = kept.contains(points_[p].point) ? 1 : 0;
    }
  }

  // Returns the remaining points in lattice order; too many if the context says to stop.
  std::vector<PointIndex> Prune() {
    RemoveThin();
    do {
      RemoveSimple();
    } while (!poll_.StoppedNow() && RemoveTwigs());
    return set_.Points();
  }

  LatticePoint operator[](PointIndex p) const { return points_[p].point; }

 private:
  // Removes points worth less than the margin, in the order in which they burned.
  void RemoveThin() {
    const SheetBurning burning(points_, scale_, kept_, poll_);
    std::vector<uint32_t> turn(points_.size(), 0);  // from 1
    uint32_t turns = 0;
    for (const PointIndex p : burning.burned()) {
      ++turns;
      if (burning.WorthOf(p) < margin_) turn[p] = turns;
    }
    set_.RemoveSimple(
        burning.burned(), [&](PointIndex p) { return turn[p] != 0; },
        [&](PointIndex p) { return turn[p]; }, poll_);
  }

  // Removes points that are neither ends nor isthmuses, shallow ones first.
  void RemoveSimple() {
    const auto may_go = [&](PointIndex p) {
      return IsSimpleNonEnd(set_.mask(p)) && kept_[p] == 0 && points_[p].birth <= 0;
    };
    set_.RemoveSimple(
        set_.Points(), may_go, [&](PointIndex p) { return points_[p].radius; }, poll_);
  }

  // Removes twigs whose balls extend beyond the ball at the foot by less than the margin, with
  // distances counted half. Keeps tunnels of twigs. Returns whether it removed any.
  bool RemoveTwigs() {
    const TwigFinder finder(points_, set_.Points(), poll_);
    if (poll_.StoppedNow()) return false;
    bool any = false;
    std::vector<uint8_t> of_twig(points_.size(), 0);
    for (const Twig& twig : finder.Find()) {
      const auto way = [&](PointIndex p) {
        return StraightDistance(points_[p].point, points_[twig.foot].point, scale_);
      };
      const double limit = points_[twig.foot].radius + margin_;
      const bool spurious = std::ranges::all_of(twig.points, [&](PointIndex p) {
        return kept_[p] == 0 && kTwigSlope * way(p) + points_[p].radius < limit;
      });
      if (!spurious) continue;
      for (const PointIndex p : twig.points) of_twig[p] = 1;
      any |= set_.RemoveSimple(
          twig.points, [&](PointIndex p) { return of_twig[p] != 0; },
          [&](PointIndex p) { return -way(p); }, poll_);
      for (const PointIndex p : twig.points) of_twig[p] = 0;
    }
    return any;
  }

  const AxisScale scale_;
  const double margin_;
  StopPoll poll_;
  const ThinPoints points_;
  SheetSet set_;
  std::vector<uint8_t> kept_;  // by point
};

}  // namespace

absl::StatusOr<ThinSkeleton> PruneSheets(const ThinSkeleton& sheets, double margin,
                                         std::span<const LatticePoint> keep,
                                         const exec::Context& context) {
  VolumeBuilder builder(sheets.points.extent(), sheets.points.placement());
  {
    SheetPruner pruner(sheets, margin, keep, context);
    for (const PointIndex p : pruner.Prune()) builder.Add(pruner[p]);
    if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  }
  ThinSkeleton pruned{*std::move(builder).Build(), {}};
  std::vector<LatticePoint> left;
  pruned.points.ForEachPoint([&](LatticePoint p) { left.push_back(p); });
  // The same order as before, with gaps.
  size_t before = 0;
  sheets.points.ForEachPoint([&](LatticePoint p) {
    const size_t n = pruned.radii.size();
    if (n < left.size() && left[n] == p) {
      pruned.radii.push_back(sheets.radii[before]);
      if (!sheets.births.empty()) pruned.births.push_back(sheets.births[before]);
    }
    ++before;
  });
  return pruned;
}

}  // namespace bccskel
