#include "core/pruning/tips.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "core/pruning/border_tips.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/tip_placer.h"

namespace bccskel {
namespace {

// Places tips of a set that other workers read, too: each as if it were the first.
class TipTrial {
 public:
  struct Placed {
    std::vector<ThinSet::Change> changes;
    PointsByAxis at_border;
  };

  TipTrial(int worker, const ThinSet& set, const TipTask& task, TipDepths& depths)
      : set_(ThinSet::Over(set)),
        depths_(worker, depths, task.in.WhereDepthsAre(), task.in.radius),
        placer_(set_, task, *depths_) {}

  Placed Place(LatticePoint end) {
    placer_.Place(end);
    return {set_.TakeChanges(), placer_.TakeAtBorder()};
  }

 private:
  ThinSet set_;
  DepthsOfWorker depths_;
  TipPlacer placer_;
};

// The other end of a path that was led to the border. There its curve is straight now, which shows
// the way of the limb at the other end, too.
std::optional<LatticePoint> OtherEnd(const TipTrial::Placed& placed, LatticePoint end,
                                     const ThinSet& set) {
  const auto none = [](const std::vector<LatticePoint>& points) { return points.empty(); };
  if (std::ranges::all_of(placed.at_border, none) || !set.Contains(end) || !set.IsEnd(end)) {
    return std::nullopt;
  }
  const FreeBranch branch = BranchFrom(set, end);
  return branch.junction.has_value() ? std::nullopt : std::optional(branch.points.back());
}

void Append(const PointsByAxis& more, PointsByAxis& points) {
  for (size_t axis = 0; axis < points.size(); ++axis) {
    points[axis].insert(points[axis].end(), more[axis].begin(), more[axis].end());
  }
}

}  // namespace

absl::StatusOr<PointsByAxis> PlaceTips(ThinSet& set, const PrunedObject& in, TipDepths& depths,
                                       const PointSet& keep, const SurfaceNoise& noise,
                                       const TurnedTips& turned, const exec::Context& context,
                                       const std::function<void()>& meanwhile) {
  const TipTask task = {in, keep, noise, turned, BallIndex(set, context)};
  const std::vector<LatticePoint> ends = set.Ends();
  std::vector<TipTrial::Placed> placed(ends.size());
  const int workers = context.WorkersFor(1 + ends.size(), Significance::kWork);
  (void)context.ForEach(workers, 1 + ends.size(), 1, [&](int worker) {
    return [&, trial = TipTrial(worker, set, task, depths)](size_t n) mutable {
      if (n == 0) return meanwhile();
      placed[n - 1] = trial.Place(ends[n - 1]);
    };
  });
  PointsByAxis at_border;
  PointSet anew;  // the other ends of paths that were led to the border
  std::optional<TipPlacer> placer;
  for (size_t n = 0; n < ends.size(); ++n) {
    if (context.ShouldStop()) return context.StopStatus();
    const std::optional<LatticePoint> other = OtherEnd(placed[n], ends[n], set);
    if (!anew.contains(ends[n]) && set.Apply(placed[n].changes)) {
      Append(placed[n].at_border, at_border);
      if (other.has_value()) anew.insert(*other);
      continue;
    }
    if (!placer.has_value()) placer.emplace(set, task, depths);
    placer->Place(ends[n]);
    Append(placer->TakeAtBorder(), at_border);
  }
  if (in.image.has_value()) {
    ExactRadius radius = in.radius;
    BorderTips(in.object, *in.image).AddBranches(radius, set, at_border, context);
    if (context.ShouldStop()) return context.StopStatus();
  }
  return at_border;
}

}  // namespace bccskel
