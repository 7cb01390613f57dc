#ifndef BCCSKEL_CORE_PIPELINE_METHOD_IN_WORDS_H_
#define BCCSKEL_CORE_PIPELINE_METHOD_IN_WORDS_H_

#include <string>

#include "core/distance/distance_field.h"
#include "core/pipeline/skeletonize.h"
#include "core/thinning/thinning.h"

namespace bccskel {

// The kind of skeleton and the method, in one line for users of the result.
std::string MethodInWords(const ThinningOptions& thinning, DistanceKind distance,
                          ObjectSource source = ObjectSource::kPoints);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_METHOD_IN_WORDS_H_
