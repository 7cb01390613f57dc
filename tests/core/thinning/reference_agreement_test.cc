#include <gtest/gtest.h>

#include <vector>

#include "core/thinning/thinning.h"
#include "tests/core/thinning/thin.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/reference_thinner.h"
#include "tests/support/sanitized.h"

// The engine gives the bits of the slow reference, for all options and any number of threads.

namespace bccskel {
namespace {

using test::PlacedVolume, test::Thin;

constexpr StubblePolicy kPolicies[] = {StubblePolicy::kKeepTwo, StubblePolicy::kLiteral,
                                       StubblePolicy::kNone};
constexpr ThinnessCleanup kCleanups[] = {ThinnessCleanup::kOn, ThinnessCleanup::kOff};
constexpr double kWidths[] = {1, 0.75, 2};
constexpr ThinningMethod kMethods[] = {ThinningMethod::kDirectional,
                                       ThinningMethod::kDirectionalAlternating};
constexpr int32_t kLastShells[] = {0, 1, 2, 3};
constexpr double kKeptFractions[] = {0, 0.02};
constexpr int kTeams[] = {2, 3, 8};

// The options of combination `n` of the 144 there are; the two methods take turns.
ThinningOptions Combination(size_t n, std::span<const LatticePoint> points) {
  ThinningOptions options;
  options.method = kMethods[n / 2 % 2];
  options.stubble = kPolicies[n % 3];
  options.shell_width = kWidths[n / 3 % 3];
  options.cleanup = kCleanups[n / 9 % 2];
  options.last_shell = kLastShells[n / 18 % 4];
  options.keep = test::RandomSubset(n, points, kKeptFractions[n / 72 % 2]);
  return options;
}
constexpr size_t kCombinations = 144;

// One worker, and a team whose size changes with `turn`.
void ExpectAgreement(const Volume& object, const ThinningOptions& options, size_t turn) {
  const test::ReferenceThinning expected = test::ReferenceThinCounted(object, options);
  for (int threads : {1, kTeams[turn % 3]}) {
    SCOPED_TRACE(testing::Message() << threads << " threads");
    const ThinningResult result = Thin(object, options, threads);
    ASSERT_EQ(result.last_shell, expected.last_shell);
    ASSERT_TRUE(result.thin.SortedPoints() == expected.thin)
        << result.thin.PointCount() << " points instead of " << expected.thin.size();
    ASSERT_EQ(result.removed, expected.removed);
    ASSERT_EQ(result.removed_by_cleanup, expected.removed_by_cleanup);
    ASSERT_EQ(result.passes, expected.passes);
    ASSERT_EQ(result.thin.extent(), object.extent());
  }
}

void ExpectAgreementOnSeveralCombinations(uint64_t seed, const Volume& object) {
  const std::vector<LatticePoint> points = object.SortedPoints();
  for (size_t n : {seed * 3, seed * 3 + 1, seed * 3 + 77}) {
    SCOPED_TRACE(testing::Message() << "combination " << n % kCombinations);
    ExpectAgreement(object, Combination(n % kCombinations, points), seed);
  }
}

TEST(ReferenceAgreementLaw, HoldsOnRandomClouds) {
  for (uint64_t seed = 0; seed < 96; seed += test::kStride) {
    SCOPED_TRACE(seed);
    const double density = 0.2 + 0.6 * static_cast<double>(seed) / 95;
    const auto cloud = test::RandomCloud(seed, {10, 7, 9}, density);
    ExpectAgreementOnSeveralCombinations(seed, PlacedVolume(seed, cloud));
    if (HasFatalFailure()) return;
  }
}

TEST(ReferenceAgreementLaw, HoldsOnNoisyBlobs) {
  for (uint64_t seed = 0; seed < 96; seed += test::kStride) {
    SCOPED_TRACE(seed);
    const double noise = 0.002 * static_cast<double>(seed);
    const auto blob = test::RandomBlob(seed, {9, 8, 10}, 4, 9);
    const auto noisy = test::WithNoisyBoundary(seed, blob, noise);
    ExpectAgreementOnSeveralCombinations(seed, PlacedVolume(seed, noisy));
    if (HasFatalFailure()) return;
  }
}

TEST(ReferenceAgreementLaw, HoldsForEveryCombinationOfOptions) {
  const auto blob = test::WithNoisyBoundary(4, test::RandomBlob(4, {10, 10, 10}, 5, 8), 0.1);
  const Volume object = PlacedVolume(11, blob);
  const std::vector<LatticePoint> points = object.SortedPoints();
  for (size_t n = 0; n < kCombinations; n += test::kStride) {
    SCOPED_TRACE(n);
    ExpectAgreement(object, Combination(n, points), n / 3);
    if (HasFatalFailure()) return;
  }
}

TEST(ReferenceAgreement, HoldsOnObjectsOfNoneOneAndTwoPoints) {
  const std::vector<LatticePoint> one = {{0, 0, 0}}, two = {{31, 7, 15}, {32, 8, 16}};
  ExpectAgreement(VolumeOfPoints({}), {}, 0);
  ExpectAgreement(VolumeOfPoints(one), {}, 1);
  ExpectAgreement(VolumeOfPoints(two), {}, 2);
}

class ThinningLaw : public testing::TestWithParam<uint64_t> {
 protected:
  std::vector<LatticePoint> Points() const { return test::CloudOrNoisyBlob(GetParam()); }
};

TEST_P(ThinningLaw, KeepsTheTopologyAndLeavesNoSimpleNonEndPoint) {
  const Volume object = VolumeOfPoints(Points());
  for (StubblePolicy stubble : kPolicies) {
    ThinningOptions options;
    options.stubble = stubble;
    const test::ReferencePointSet thin(Thin(object, options, 2).thin);
    EXPECT_EQ(test::ReferenceBetti(thin), test::ReferenceBetti(test::ReferencePointSet(object)));
    EXPECT_EQ(test::ReferenceSimpleNonEndPoints(thin), 0u);
  }
}

TEST_P(ThinningLaw, KeepsTheTopologyAfterAnyShell) {
  const Volume object = VolumeOfPoints(Points());
  const BettiNumbers betti = test::ReferenceBetti(test::ReferencePointSet(object));
  for (int32_t shell = 1; shell <= 4; ++shell) {
    ThinningOptions options;
    options.last_shell = shell;
    const test::ReferencePointSet thin(Thin(object, options, 1).thin);
    EXPECT_EQ(test::ReferenceBetti(thin), betti) << shell;
  }
}

TEST_P(ThinningLaw, ChangesNothingTheSecondTimeWithoutStubbleRemoval) {
  ThinningOptions options;
  options.stubble = StubblePolicy::kNone;
  const Volume once = Thin(VolumeOfPoints(Points()), options, 2).thin;
  const ThinningResult twice = Thin(once, options, 2);
  EXPECT_EQ(twice.thin, once);
  EXPECT_EQ(twice.removed + twice.removed_by_cleanup, 0u);
}

TEST_P(ThinningLaw, ChangesNothingTheSecondTimeWithoutCleanup) {
  for (StubblePolicy stubble : kPolicies) {
    ThinningOptions options;
    options.stubble = stubble;
    options.cleanup = ThinnessCleanup::kOff;
    const Volume once = Thin(VolumeOfPoints(Points()), options, 2).thin;
    EXPECT_EQ(Thin(once, options, 2).thin, once);
  }
}

// A shift by a lattice vector whose coordinates sum to a multiple of four keeps the subfields.
TEST_P(ThinningLaw, MovesWithTheObject) {
  const LatticePoint by = {14, 6, 24};
  ASSERT_TRUE(IsOnLattice(by) && (by.x + by.y + by.z) % 4 == 0);
  test::ExpectMovesWithTheObject(Points(), by, {});
}

TEST_P(ThinningLaw, MovesByAnyLatticeVectorWithoutCleanup) {
  ThinningOptions options;
  options.cleanup = ThinnessCleanup::kOff;
  for (LatticePoint by : {LatticePoint{2, 0, 0}, {1, 1, 1}, {17, 5, 11}, {0, 6, 14}}) {
    test::ExpectMovesWithTheObject(Points(), by, options);
  }
}

TEST_P(ThinningLaw, NeverRemovesKeptPoints) {
  const std::vector<LatticePoint> points = Points();
  ThinningOptions options;
  options.keep = test::RandomSubset(GetParam(), points, 0.05);
  options.keep.push_back({1 << 20, 0, 0});  // not a point of the object: ignored
  const Volume thin = Thin(VolumeOfPoints(points), options, 2).thin;
  options.keep.pop_back();
  for (LatticePoint p : options.keep) EXPECT_TRUE(thin.Contains(p));
}

INSTANTIATE_TEST_SUITE_P(Seeds, ThinningLaw, testing::Range<uint64_t>(1, 10));

}  // namespace
}  // namespace bccskel
