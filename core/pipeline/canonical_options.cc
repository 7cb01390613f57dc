#include "core/pipeline/canonical_options.h"

#include "core/pruning/prune.h"
#include "core/pruning/sheet_pruner.h"

namespace bccskel {

bool HasCurves(const ThinningOptions& options) {
  return options.last_shell == 0 &&
         (options.kind == SkeletonKind::kCurve || options.kind == SkeletonKind::kIsthmusCurve);
}

bool HasSheets(const ThinningOptions& options) {
  return options.last_shell == 0 && options.kind == SkeletonKind::kSurface;
}

bool HasGraphOfCurves(const ThinningOptions& options) {
  return options.last_shell == 0 && options.kind != SkeletonKind::kSurface;
}

SkeletonizeOptions CanonicalOptions(SkeletonizeOptions options) {
  if (HasSheets(options.thinning)) {
    options.pruning.tips = TipPlacement::kAsThinned;
    if (options.pruning.threshold == 0) {
      options.pruning.threshold = kDefaultSheetMargin * SurfaceStepOf(options.source);
    }
  } else if (!HasCurves(options.thinning)) {
    options.pruning = {.rule = PruningRule::kNone, .tips = TipPlacement::kAsThinned};
  }
  if (!HasGraphOfCurves(options.thinning)) options.junction_reach = 0;
  options.pruning = WithDefaults(options.pruning);
  if (options.border == Border::kContinuesAcrossSlice) options.border = Border::kAuto;
  return options;
}

}  // namespace bccskel
