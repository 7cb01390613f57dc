#ifndef BCCSKEL_TESTS_QUALITY_METHODS_H_
#define BCCSKEL_TESTS_QUALITY_METHODS_H_

#include <array>

#include "absl/status/statusor.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::quality {

struct Method {
  const char* name;
  ThinningMethod thinning;
  DistanceKind distance;
};
inline constexpr std::array<Method, 6> kMethods = {{
    {"symmetric, chamfer", ThinningMethod::kSymmetric, DistanceKind::kChamfer},
    {"symmetric, Euclidean", ThinningMethod::kSymmetric, DistanceKind::kEuclidean},
    {"directional-alternating, chamfer", ThinningMethod::kDirectionalAlternating,
     DistanceKind::kChamfer},
    {"directional-alternating, Euclidean", ThinningMethod::kDirectionalAlternating,
     DistanceKind::kEuclidean},
    {"directional, chamfer", ThinningMethod::kDirectional, DistanceKind::kChamfer},
    {"directional, Euclidean", ThinningMethod::kDirectional, DistanceKind::kEuclidean},
}};

// One distance for each: the default, and the paper's with the paper's methods.
constexpr bool IsMain(const Method& method) {
  const bool symmetric = method.thinning == ThinningMethod::kSymmetric;
  return symmetric == (method.distance == DistanceKind::kEuclidean);
}

inline absl::StatusOr<SkeletonizeResult> SkeletonizeBy(const Method& method, const Volume& object) {
  return Skeletonize(object, {.thinning = {.method = method.thinning}, .distance = method.distance},
                     exec::Context());
}

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_METHODS_H_
