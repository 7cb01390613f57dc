#include <gtest/gtest.h>

#include <vector>

#include "core/distance/distance_field.h"
#include "core/exec/instruction_sets.h"
#include "core/exec/worker_team.h"
#include "core/thinning/thinning.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_conditions.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/reference_thinner.h"

// The engine gives the bits of the slow reference for the symmetric method and every kind, and the
// laws of these skeletons hold.

namespace bccskel {
namespace {

constexpr SkeletonKind kKinds[] = {SkeletonKind::kCurve, SkeletonKind::kSurface,
                                   SkeletonKind::kKernel, SkeletonKind::kIsthmusCurve};
constexpr StubblePolicy kPolicies[] = {StubblePolicy::kKeepTwo, StubblePolicy::kNone,
                                       StubblePolicy::kLiteral};
constexpr double kWidths[] = {1, 0.75, 2};
constexpr int32_t kLastShells[] = {0, 0, 1, 2, 3};
constexpr int kTeams[] = {2, 3, 8};

ThinningOptions Combination(uint64_t n, std::span<const LatticePoint> points) {
  ThinningOptions options;
  options.method = ThinningMethod::kSymmetric;
  options.kind = kKinds[n % 4];
  options.stubble = kPolicies[n / 4 % 3];
  options.shell_width = kWidths[n / 3 % 3];
  options.last_shell = kLastShells[n % 5];
  options.keep = test::RandomSubset(n, points, n % 7 == 0 ? 0.02 : 0);
  return options;
}

ThinningResult Thin(const Volume& object, const ThinningOptions& options, int threads) {
  exec::WorkerTeam team(threads);
  exec::Context context;
  context.team = &team;
  context.min_bricks_per_worker = 1;
  auto result = ThinToCurve(object, *ComputeDistance(object, DistanceKind::kChamfer, context), options, context);
  EXPECT_TRUE(result.ok()) << result.status();
  return *std::move(result);
}

void ExpectAgreement(const Volume& object, const ThinningOptions& options, uint64_t turn) {
  const test::ReferenceThinning expected = test::ReferenceThinCounted(object, options);
  ASSERT_EQ(expected.removed_by_cleanup, 0u);
  for (int threads : {1, kTeams[turn % 3]}) {
    SCOPED_TRACE(testing::Message() << threads << " threads");
    const ThinningResult result = Thin(object, options, threads);
    ASSERT_TRUE(result.thin.SortedPoints() == expected.thin)
        << result.thin.PointCount() << " points instead of " << expected.thin.size();
    ASSERT_EQ(result.removed, expected.removed);
    ASSERT_EQ(result.removed_by_cleanup, 0u);
    ASSERT_EQ(result.passes, expected.passes);
  }
}

// Moves the object so that it crosses bricks in another place for each seed.
Volume PlacedVolume(uint64_t seed, std::span<const LatticePoint> points) {
  const auto step = [seed](uint64_t stride, uint64_t range) {
    return static_cast<int32_t>(seed * stride % range);
  };
  const int32_t odd = static_cast<int32_t>(seed % 2);
  const LatticePoint by = {2 * step(5, 17) + odd, 2 * step(3, 5) + odd, 2 * step(7, 9) + odd};
  return VolumeOfPoints(test::Translated(points, by));
}

TEST(SymmetricAgreementLaw, HoldsOnRandomClouds) {
  for (uint64_t seed = 0; seed < 120; ++seed) {
    SCOPED_TRACE(seed);
    const auto cloud =
        test::RandomCloud(seed, {10, 7, 9}, 0.2 + 0.6 * static_cast<double>(seed) / 119);
    const Volume object = PlacedVolume(seed, cloud);
    ExpectAgreement(object, Combination(seed, object.SortedPoints()), seed);
    if (HasFatalFailure()) return;
  }
}

TEST(SymmetricAgreementLaw, HoldsOnNoisyBlobs) {
  for (uint64_t seed = 0; seed < 120; ++seed) {
    SCOPED_TRACE(seed);
    const auto blob = test::RandomBlob(seed, {9, 8, 10}, 4, 9);
    const auto noisy = test::WithNoisyBoundary(seed, blob, 0.0016 * static_cast<double>(seed));
    const Volume object = PlacedVolume(seed, noisy);
    ExpectAgreement(object, Combination(seed, object.SortedPoints()), seed);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace bccskel
