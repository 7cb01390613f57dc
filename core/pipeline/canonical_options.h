#ifndef BCCSKEL_CORE_PIPELINE_CANONICAL_OPTIONS_H_
#define BCCSKEL_CORE_PIPELINE_CANONICAL_OPTIONS_H_

#include "core/pipeline/skeletonize.h"

namespace bccskel {

// Whether the result has curves, which are pruned and have tips. It has none if thinning stops at a
// shell.
bool HasCurves(const ThinningOptions& options);

// Whether the result has sheets, which are pruned.
bool HasSheets(const ThinningOptions& options);

// Whether the result is a graph of curves alone, whose junctions are merged.
bool HasGraphOfCurves(const ThinningOptions& options);

// The options as they take effect: defaults filled in, no pruning if there are no curves or sheets,
// and no merging if there is no graph of curves. So options that differ only in these respects
// become equal.
SkeletonizeOptions CanonicalOptions(SkeletonizeOptions options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_CANONICAL_OPTIONS_H_
