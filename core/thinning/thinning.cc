#include "core/thinning/thinning.h"

#include <algorithm>

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

namespace {

// Thins with the rule of the method. A symmetric pass removes something as long as something is
// simple, so clean-up is for the directional methods.
absl::StatusOr<SweepTotals> Sweep(const SweepPlan& plan, const DistanceField& distance,
                                  const ThinningOptions& options, const exec::Context& context,
                                  const Volume& object, ThinningState& state) {
  if (options.method == ThinningMethod::kSymmetric) {
    const Shells depth = BuildDepths(object, distance, context);
    SymmetricRule rule(depth, options.kind, state);
    return SweepShells(plan, rule, context, state);
  }
  const bool alternating = options.method == ThinningMethod::kDirectionalAlternating;
  DirectionRule rule(state, alternating ? DirectionOrder::kAlternating : DirectionOrder::kSame);
  return SweepShells(plan, rule, context, state);
}

}  // namespace

absl::StatusOr<ThinningResult> ThinToCurve(const Volume& object, const DistanceField& distance,
                                           const ThinningOptions& options,
                                           const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckThinningOptions(options));
  ThinningResult result;
  exec::StageClock clock;
  const Shells shells = BuildShells(object, distance, options.shell_width, context);
  BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
  result.times.shells = clock.Lap();
  ThinningState state(object, options.keep);
  result.last_shell = shells.last();
  const int32_t last =
      options.last_shell == 0 ? shells.last() : std::min(options.last_shell, shells.last());
  const bool has_stubble = EndPointsOf(options.kind) == EndPoints::kStay;
  const SweepPlan plan = {shells, last, has_stubble ? options.stubble : StubblePolicy::kNone};
  BCCSKEL_ASSIGN_OR_RETURN(const SweepTotals totals,
                           Sweep(plan, distance, options, context, object, state));
  result.removed = totals.removed;
  result.passes = totals.passes;
  result.times.passes = clock.Lap();
  if (options.cleanup == ThinnessCleanup::kOn && options.method != ThinningMethod::kSymmetric) {
    BCCSKEL_ASSIGN_OR_RETURN(result.removed_by_cleanup, CleanUpThinness(context, state));
  }
  result.times.cleanup = clock.Lap();
  result.thin = std::move(state).ToVolume(object);
  result.times.passes += clock.Lap();
  return result;
}

}  // namespace bccskel
