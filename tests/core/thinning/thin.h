#ifndef BCCSKEL_TESTS_CORE_THINNING_THIN_H_
#define BCCSKEL_TESTS_CORE_THINNING_THIN_H_

#include <gtest/gtest.h>

#include <utility>

#include "core/distance/distance_field.h"
#include "core/thinning/thinning.h"
#include "tests/support/contexts.h"

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

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_THINNING_THIN_H_
