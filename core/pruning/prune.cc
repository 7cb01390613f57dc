#include "core/pruning/prune.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/distance/exact_radius.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/tips.h"
#include "core/topology/neighborhood.h"

// Does:  takes spurious branches away, the least first, and looks again at what is left of the
//        junction: two branches that remain of three become one.
// Why it is right: a branch is removed from its end on, and an end point is simple; then points at
//   the junction that have become simple go one after the other. So nothing but branches with a
//   free end can vanish, and of a path with two ends nothing does.
// Cost:  follows the points of the branches that end; each removal looks at one junction.

namespace bccskel {
namespace {

constexpr double kDefaultSlopeMargin = 4;
constexpr double kDefaultRelativeLength = 1;
// A cavity leaves a whole surface as one cluster; what lies this far from the branch says nothing
// about it.
constexpr size_t kMostClusterPoints = 64;

double ThresholdOf(const PruningOptions& options) {
  if (options.threshold != 0) return options.threshold;
  return options.rule == PruningRule::kSlope ? kDefaultSlopeMargin : kDefaultRelativeLength;
}

class BranchPruner {
 public:
  BranchPruner(ThinSet& set, const PruningOptions& options, double world_units,
               const PointSet& keep, const exec::Context& context)
      : set_(set),
        rule_(options.rule),
        threshold_(ThresholdOf(options) / (options.rule == PruningRule::kLength ? world_units : 1)),
        keep_(keep),
        context_(context) {}

  // Returns how many branches went.
  uint64_t Run() {
    uint64_t removed = 0;
    for (LatticePoint end : set_.Ends()) Judge(end);
    while (!turns_.empty() && !context_.ShouldStop()) {
      const auto [worth, end] = turns_.top();
      turns_.pop();
      if (!IsEnd(end)) continue;
      const FreeBranch branch = BranchFrom(set_, end);
      const std::optional<double> now = WorthIfSpurious(branch);
      if (!now.has_value()) continue;
      if (*now != worth) {
        turns_.emplace(*now, end);
        continue;
      }
      RemoveBranch(branch);
      ++removed;
    }
    return removed;
  }

 private:
  bool IsEnd(LatticePoint p) const { return set_.Contains(p) && set_.Degree(p) == 1; }

  void Judge(LatticePoint end) {
    const std::optional<double> worth = WorthIfSpurious(BranchFrom(set_, end));
    if (worth.has_value()) turns_.emplace(*worth, end);
  }

  std::optional<double> WorthIfSpurious(const FreeBranch& branch) const {
    if (!branch.junction.has_value()) return std::nullopt;
    if (std::ranges::any_of(branch.points, [&](LatticePoint p) { return keep_.contains(p); })) {
      return std::nullopt;
    }
    const LatticePoint junction = *branch.junction;
    float ball = 0;
    for (LatticePoint p : ClusterOf(junction)) ball = std::max(ball, set_.RadiusOf(p));
    if (rule_ == PruningRule::kSlope) return WorthBySlope(branch, junction, ball);
    const double length = LengthTo(branch, junction);
    const double most = rule_ == PruningRule::kLength ? threshold_ : threshold_ * ball;
    return length < most ? std::optional(length) : std::nullopt;
  }

  // How far the branch's ball at the end reaches out of the junction's.
  std::optional<double> WorthBySlope(const FreeBranch& branch, LatticePoint junction,
                                     float ball) const {
    for (LatticePoint p : branch.points) {
      const double reach = 0.5 * set_.Between(p, junction) + set_.RadiusOf(p);
      if (reach >= ball + threshold_) return std::nullopt;
    }
    const LatticePoint tip = branch.points.front();
    return set_.Between(tip, junction) + set_.RadiusOf(tip) - ball;
  }

  double LengthTo(const FreeBranch& branch, LatticePoint junction) const {
    double length = set_.Between(branch.points.back(), junction);
    for (size_t n = 1; n < branch.points.size(); ++n) {
      length += set_.Between(branch.points[n - 1], branch.points[n]);
    }
    return length;
  }

  // Points with three and more neighbors around a junction point.
  std::vector<LatticePoint> ClusterOf(LatticePoint junction) const {
    std::vector<LatticePoint> cluster = {junction};
    for (size_t n = 0; n < cluster.size() && cluster.size() < kMostClusterPoints; ++n) {
      ForEachNeighbor(cluster[n], set_.NeighborsOf(cluster[n]), [&](LatticePoint q) {
        if (set_.Degree(q) > 2 && std::ranges::find(cluster, q) == cluster.end()) {
          cluster.push_back(q);
        }
      });
    }
    return cluster;
  }

  void RemoveBranch(const FreeBranch& branch) {
    const LatticePoint junction = *branch.junction;
    for (LatticePoint p : branch.points) set_.Remove(p);
    for (LatticePoint p : CleanUpAround(junction)) {
      if (set_.Contains(p)) JudgeAround(p);
    }
  }

  // Removes what is simple now, shallow points first. Returns the places that were looked at.
  std::vector<LatticePoint> CleanUpAround(LatticePoint junction) {
    std::vector<LatticePoint> seen = {junction};
    std::set<std::pair<float, LatticePoint>> turns = {{set_.RadiusOf(junction), junction}};
    const auto add = [&](LatticePoint q) {
      turns.emplace(set_.RadiusOf(q), q);
      if (std::ranges::find(seen, q) == seen.end()) seen.push_back(q);
    };
    ForEachNeighbor(junction, set_.NeighborsOf(junction), add);
    while (!turns.empty()) {
      const LatticePoint p = turns.begin()->second;
      turns.erase(turns.begin());
      const NeighborMask neighbors = set_.NeighborsOf(p);
      if (!IsSimpleNonEnd(neighbors) || keep_.contains(p)) continue;
      set_.Remove(p);
      ForEachNeighbor(p, neighbors, add);
    }
    return seen;
  }

  // Looks again at the branches with a free end that start near p.
  void JudgeAround(LatticePoint p) {
    if (set_.Degree(p) <= 2) {
      JudgeBeyond(p);
      return;
    }
    for (LatticePoint q : ClusterOf(p)) JudgeBeyond(q);
  }

  void JudgeBeyond(LatticePoint p) {
    if (set_.Degree(p) == 1) Judge(p);
    ForEachNeighbor(p, set_.NeighborsOf(p), [&](LatticePoint q) {
      LatticePoint previous = p;
      while (set_.Degree(q) == 2 && q != p) {
        const LatticePoint next = NextPoint(q, set_.NeighborsOf(q), previous);
        previous = q;
        q = next;
      }
      if (set_.Degree(q) == 1) Judge(q);
    });
  }

  using Turn = std::pair<double, LatticePoint>;

  ThinSet& set_;
  const PruningRule rule_;
  const double threshold_;
  const PointSet& keep_;
  const exec::Context& context_;
  std::priority_queue<Turn, std::vector<Turn>, std::greater<>> turns_;
};

}  // namespace

absl::Status CheckPruningOptions(const PruningOptions& options) {
  if (!(options.threshold >= 0 && options.threshold <= 1e9)) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "pruning threshold %g: must be 0 (the rule's default) to 1e9", options.threshold));
  }
  if (options.rule == PruningRule::kLength && options.threshold == 0) {
    return absl::InvalidArgumentError(
        "pruning by length: needs a threshold above 0, the length in world units");
  }
  return absl::OkStatus();
}

absl::StatusOr<PrunedSkeleton> Prune(const Volume& thin, std::span<const float> radii,
                                     const Volume& object, const DistanceField& field,
                                     std::span<const LatticePoint> keep,
                                     const PruningOptions& options, const exec::Context& context) {
  if (absl::Status checked = CheckPruningOptions(options); !checked.ok()) return checked;
  if (thin.empty()) return PrunedSkeleton{thin, {}, 0};
  ThinSet set(thin, radii);
  const PointSet kept(keep.begin(), keep.end());
  PrunedSkeleton pruned;
  if (options.rule != PruningRule::kNone) {
    const double world_units = WorldUnitsPerLatticeUnit(thin.placement());
    pruned.branches_removed = BranchPruner(set, options, world_units, kept, context).Run();
  }
  if (options.tips == TipPlacement::kRidge) {
    ExactRadius radius(object, field);
    PlaceTips(set, radius, object, kept, context);
  }
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  pruned.thin = set.ToVolume(thin);
  pruned.radii = set.RadiiOf(pruned.thin);
  return pruned;
}

}  // namespace bccskel
