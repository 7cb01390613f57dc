#ifndef BCCSKEL_CORE_PIPELINE_ALGORITHM_VERSION_H_
#define BCCSKEL_CORE_PIPELINE_ALGORITHM_VERSION_H_

#include "core/pipeline/skeletonize.h"

namespace bccskel {

// Raised whenever the same volume and options may give another skeleton: stored results are found
// again by it.
inline constexpr char kAlgorithmVersion[] = "12";

// The same for masks, whose conversion counts, too.
inline constexpr char kMaskAlgorithmVersion[] = "12.mask-3";

constexpr const char* AlgorithmVersionOf(ObjectSource source) {
  return source == ObjectSource::kPoints ? kAlgorithmVersion : kMaskAlgorithmVersion;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_ALGORITHM_VERSION_H_
