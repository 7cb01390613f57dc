#include "core/thinning/thinning.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/stage_clock.h"
#include "core/exec/status_macros.h"
#include "core/thinning/cleanup.h"
#include "core/thinning/direction_rule.h"
#include "core/thinning/shell_sweep.h"
#include "core/thinning/symmetric_rule.h"

namespace bccskel {

absl::Status CheckThinningOptions(const ThinningOptions& options) {
  if (!(options.shell_width >= kMinShellWidth && options.shell_width <= kMaxShellWidth)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("shell width %g: must be %g to %g lattice units", options.shell_width,
                        kMinShellWidth, kMaxShellWidth));
  }
  if (options.last_shell < 0) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "last shell %d: must be 0 (thin to the end) or a shell from 1 up", options.last_shell));
  }
  if (options.kind != SkeletonKind::kCurve && options.method != ThinningMethod::kSymmetric) {
    return absl::InvalidArgumentError(
        "the directional methods give curves only: other kinds of skeletons need the symmetric "
        "one");
  }
  return absl::OkStatus();
}

int32_t LastShellOf(const ThinningOptions& options, const Shells& shells) {
  return options.last_shell == 0 ? shells.last() : std::min(options.last_shell, shells.last());
}

StubblePolicy StubbleOf(const ThinningOptions& options) {
  const bool has_stubble = EndPointsOf(options.kind) == EndPoints::kStay;
  return has_stubble ? options.stubble : StubblePolicy::kNone;
}

namespace {

// Finds the points of an object that were removed since the last call.
class PeeledPoints {
 public:
  // `object` must outlive this.
  explicit PeeledPoints(const Volume& object)
      : object_(object), before_(object.bricks().begin(), object.bricks().end()) {}

  // Shapes: `now` in the brick order of the object, padded or not; a subset of the previous one.
  Volume Take(std::span<const BrickBits> now) {
    std::vector<BrickKey> keys;
    std::vector<BrickBits> gone;
    for (size_t n = 0; n < before_.size(); ++n) {
      if (before_[n] == now[n]) continue;
      keys.push_back(object_.keys()[n]);
      gone.push_back(before_[n] & ~now[n]);
      before_[n] = now[n];
    }
    return Volume::FromSortedBricks(object_.extent(), object_.placement(), std::move(keys),
                                    std::move(gone));
  }

 private:
  const Volume& object_;
  std::vector<BrickBits> before_;
};

// One run, stage by stage.
class Thinning {
 public:
  Thinning(const Volume& object, const ThinningOptions& options, const exec::Context& context,
           const OnShellPoints& on_points)
      : object_(object),
        options_(options),
        context_(context),
        on_points_(on_points),
        state_(object, options.keep) {}

  absl::StatusOr<ThinningResult> Run(const Shells& shells, const BrickDepths& depths) && {
    BCCSKEL_RETURN_IF_ERROR(context_.StopStatus());
    result_.times.shells = clock_.Lap();
    // A symmetric pass removes points as long as any are simple, so there is nothing to clean up.
    if (options_.method == ThinningMethod::kSymmetric) {
      BCCSKEL_RETURN_IF_ERROR(SweepSymmetrically(shells, depths));
    } else {
      DirectionRule rule(state_, options_.method);
      BCCSKEL_RETURN_IF_ERROR(Sweep(shells, rule));
      BCCSKEL_RETURN_IF_ERROR(CleanUp(shells));
    }
    result_.thin = std::move(state_).ToVolume(object_);
    result_.times.passes += clock_.Lap();
    return std::move(result_);
  }

 private:
  absl::Status CleanUp(const Shells& shells) {
    if (options_.cleanup == ThinnessCleanup::kOn) {
      BCCSKEL_ASSIGN_OR_RETURN(result_.removed_by_cleanup, CleanUpThinness(context_, state_));
      if (peeled_.has_value()) on_points_(shells.last() + 1, peeled_->Take(state_.object));
    }
    result_.times.cleanup = clock_.Lap();
    return absl::OkStatus();
  }

  absl::Status SweepSymmetrically(const Shells& shells, const BrickDepths& depths) {
    SymmetricRule rule(depths, options_.kind, state_);
    BCCSKEL_RETURN_IF_ERROR(Sweep(shells, rule));
    result_.isthmuses = rule.Isthmuses();
    return absl::OkStatus();
  }

  absl::Status Sweep(const Shells& shells, PassRule& rule) {
    result_.last_shell = shells.last();
    SweepPlan plan = {shells, LastShellOf(options_, shells), StubbleOf(options_)};
    if (on_points_) {
      peeled_.emplace(object_);
      plan.after_shell = [this](int32_t shell) { on_points_(shell, peeled_->Take(state_.object)); };
    }
    BCCSKEL_ASSIGN_OR_RETURN(const SweepTotals totals, SweepShells(plan, rule, context_, state_));
    result_.removed = totals.removed;
    result_.passes = totals.passes;
    result_.times.passes = clock_.Lap();
    return absl::OkStatus();
  }

  const Volume& object_;
  const ThinningOptions& options_;
  const exec::Context& context_;
  const OnShellPoints& on_points_;
  std::optional<PeeledPoints> peeled_;
  exec::StageClock clock_;
  ThinningState state_;
  ThinningResult result_;
};

}  // namespace

std::vector<int32_t> BirthsOf(const ThinningResult& result) {
  std::vector<int32_t> births;
  births.reserve(result.thin.PointCount());
  result.thin.ForEachPoint([&](LatticePoint p) {
    const auto found = std::ranges::lower_bound(result.isthmuses, p, {}, &IsthmusBirth::point);
    births.push_back(found != result.isthmuses.end() && found->point == p ? found->pass : 0);
  });
  return births;
}

absl::StatusOr<ThinningResult> ThinObject(const Volume& object, const DistanceField& distance,
                                          const ThinningOptions& options,
                                          const exec::Context& context,
                                          const OnShellPoints& on_points) {
  BCCSKEL_RETURN_IF_ERROR(CheckThinningOptions(options));
  exec::StageClock clock;
  const Shells shells = BuildShells(object, distance, options.shell_width, context);
  BrickDepths depths;
  if (DepthsOf(options.method) == Depths::kWanted) depths = BuildDepths(object, distance, context);
  const auto shells_time = clock.Lap();
  BCCSKEL_ASSIGN_OR_RETURN(ThinningResult result,
                           ThinByShells(object, shells, depths, options, context, on_points));
  result.times.shells += shells_time;
  return result;
}

absl::StatusOr<ThinningResult> ThinByShells(const Volume& object, const Shells& shells,
                                            const BrickDepths& depths,
                                            const ThinningOptions& options,
                                            const exec::Context& context,
                                            const OnShellPoints& on_points) {
  BCCSKEL_RETURN_IF_ERROR(CheckThinningOptions(options));
  if (DepthsOf(options.method) == Depths::kWanted && depths.size() <= object.brick_count()) {
    return absl::InvalidArgumentError("the symmetric method needs depths besides shells");
  }
  return Thinning(object, options, context, on_points).Run(shells, depths);
}

}  // namespace bccskel
