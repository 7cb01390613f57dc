#include "core/pipeline/canonical_options.h"

#include "core/pruning/pruning_defaults.h"

namespace bccskel {

bool HasCurves(const ThinningOptions& options) {
  return options.last_shell == 0 &&
         (options.kind == SkeletonKind::kCurve || options.kind == SkeletonKind::kIsthmusCurve);
}

SkeletonizeOptions CanonicalOptions(SkeletonizeOptions options) {
  if (!HasCurves(options.thinning)) {
    options.pruning = {.rule = PruningRule::kNone, .tips = TipPlacement::kAsThinned};
  }
  options.pruning = WithDefaults(options.pruning);
  return options;
}

}  // namespace bccskel
