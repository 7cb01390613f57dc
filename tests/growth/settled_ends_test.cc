// End points that stay are judged once, not in every pass. Work is counted, not timed, as in
// linear_growth_test.cc: the compiler calls the function below in each block of what judges them.
#include <gtest/gtest.h>

#include <cstdint>

#include "core/distance/distance_field.h"
#include "core/lattice/directions.h"
#include "core/thinning/thinning.h"
#include "core/volume/volume.h"
#include "tests/support/volume_where.h"

namespace {
uint64_t blocks = 0;
}

extern "C" void __sanitizer_cov_trace_pc() { ++blocks; }

namespace bccskel {
namespace {

// A ball, whose shells keep passes coming, beside straight curves of two ends each.
Volume BallAndCurves(int32_t radius, int32_t curves) {
  constexpr int32_t kSide = 60, kLength = 12, kApart = 8;
  VolumeBuilder builder({2 * kSide, kSide, kSide});
  const LatticePoint center = {kSide, kSide, kSide}, reach = {radius, radius, radius};
  test::ForEachPointIn({center - reach, center + reach}, [&](LatticePoint p) {
    if (Dot(p - center, p - center) <= radius * radius) builder.Add(p);
  });
  for (int32_t n = 0; n < curves; ++n) {
    const int32_t y = kApart * (n % 12) + 2, z = kApart * (n / 12) + 2;
    for (int32_t x = 0; x < kLength; ++x) builder.Add({2 * kSide + 60 + 2 * x, y, z});
  }
  return *std::move(builder).Build();
}

struct Thinned {
  uint64_t blocks = 0;
  uint32_t passes = 0;
};

Thinned Thin(const Volume& object, ThinningMethod method) {
  const auto distance = ComputeDistance(object, DistanceKind::kEuclidean, {});
  const uint64_t before = blocks;
  const auto result = ThinObject(object, *distance, {.method = method}, {});
  EXPECT_TRUE(result.ok()) << result.status();
  return {blocks - before, result->passes};
}

class SettledEnds : public testing::TestWithParam<ThinningMethod> {};

TEST_P(SettledEnds, CostTheSameForAnyNumberOfPasses) {
  constexpr int32_t kCurves = 144;
  const Thinned few = Thin(BallAndCurves(10, kCurves), GetParam());
  const Thinned few_alone = Thin(BallAndCurves(10, 0), GetParam());
  const Thinned many = Thin(BallAndCurves(50, kCurves), GetParam());
  const Thinned many_alone = Thin(BallAndCurves(50, 0), GetParam());
  ASSERT_GT(many.passes, 3 * few.passes);
  ASSERT_GT(few.blocks, few_alone.blocks);
  const auto once = static_cast<double>(few.blocks - few_alone.blocks);
  EXPECT_LT(static_cast<double>(many.blocks - many_alone.blocks), 1.3 * once);
}

INSTANTIATE_TEST_SUITE_P(Methods, SettledEnds,
                         testing::Values(ThinningMethod::kDirectional, ThinningMethod::kSymmetric));

}  // namespace
}  // namespace bccskel
