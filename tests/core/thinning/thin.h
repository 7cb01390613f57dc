#ifndef BCCSKEL_TESTS_CORE_THINNING_THIN_H_
#define BCCSKEL_TESTS_CORE_THINNING_THIN_H_

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "core/distance/distance_field.h"
#include "core/thinning/thinning.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"

namespace bccskel::test {

inline ThinningResult Thin(const Volume& object, const ThinningOptions& options, int threads,
                           DistanceKind kind = DistanceKind::kChamfer) {
  TeamContext context(threads);
  const auto distance = ComputeDistance(object, kind, context);
  EXPECT_TRUE(distance.ok()) << distance.status();
  auto result = ThinObject(object, *distance, options, context);
  EXPECT_TRUE(result.ok()) << result.status();
  return *std::move(result);
}

inline ThinningOptions Symmetric(SkeletonKind kind) {
  return {.method = ThinningMethod::kSymmetric, .kind = kind};
}

// An object for tests of laws: a cloud for even seeds, a noisy blob for odd ones.
inline std::vector<LatticePoint> CloudOrNoisyBlob(uint64_t seed) {
  if (seed % 2 == 0) return RandomCloud(seed, {9, 9, 9}, 0.1 * static_cast<double>(seed));
  return WithNoisyBoundary(seed, RandomBlob(seed, {12, 12, 12}, 5, 9), 0.1);
}

inline void ExpectMovesWithTheObject(const std::vector<LatticePoint>& points, LatticePoint by,
                                     const ThinningOptions& options) {
  const Volume thin = Thin(VolumeOfPoints(points), options, 2).thin;
  const Volume moved = Thin(VolumeOfPoints(Translated(points, by)), options, 2).thin;
  EXPECT_EQ(moved.SortedPoints(), Translated(thin.SortedPoints(), by));
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_THINNING_THIN_H_
