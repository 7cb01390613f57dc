#ifndef BCCSKEL_CORE_PIPELINE_CANONICAL_OPTIONS_H_
#define BCCSKEL_CORE_PIPELINE_CANONICAL_OPTIONS_H_

#include "core/pipeline/skeletonize.h"

namespace bccskel {

// Whether the result has curves, which are pruned and have tips. Where thinning stops at a shell it
// leaves none.
bool HasCurves(const ThinningOptions& options);

// The options as they take effect: defaults filled in, and no pruning where there are no curves. So
// options that differ only in these respects become equal.
// Needs: the default margin for an object of voxels is in already: see ForSteps().
SkeletonizeOptions CanonicalOptions(SkeletonizeOptions options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_CANONICAL_OPTIONS_H_
