#ifndef BCCSKEL_CORE_PIPELINE_ALGORITHM_VERSION_H_
#define BCCSKEL_CORE_PIPELINE_ALGORITHM_VERSION_H_

#include "core/pipeline/skeletonize.h"

namespace bccskel {

// Changes whenever the same volume and options may give a different skeleton. Part of the key of
// stored results.
inline constexpr char kAlgorithmVersion[] = "41";

// The same for masks; it also changes with their conversion.
inline constexpr char kMaskAlgorithmVersion[] = "41.mask-16";

constexpr const char* AlgorithmVersionOf(ObjectSource source) {
  return source == ObjectSource::kPoints ? kAlgorithmVersion : kMaskAlgorithmVersion;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_ALGORITHM_VERSION_H_
