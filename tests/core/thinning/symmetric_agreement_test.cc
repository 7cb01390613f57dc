#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <string>
#include <vector>

#include "core/exec/instruction_sets.h"
#include "core/thinning/thinning.h"
#include "tests/core/thinning/thin.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_conditions.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/reference_thinner.h"
#include "tests/support/sanitized.h"
#include "tests/support/volume_where.h"

// The engine gives the bits of the slow reference for the symmetric method and every kind, and the
// laws of these skeletons hold.

namespace bccskel::symmetric_agreement {
namespace {

using test::PlacedVolume, test::Symmetric, test::Thin;

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

void ExpectAgreement(const Volume& object, const ThinningOptions& options, uint64_t turn) {
  const test::ReferenceThinning expected = test::ReferenceThinCounted(object, options);
  ASSERT_EQ(expected.removed_by_cleanup, 0u);
  for (int threads : {1, kTeams[turn % 3]}) {
    SCOPED_TRACE(testing::Message() << threads << " threads");
    const ThinningResult result = Thin(object, options, threads);
    ASSERT_TRUE(result.thin.SortedPoints() == expected.thin)
        << result.thin.PointCount() << " points instead of " << expected.thin.size();
    ASSERT_EQ(result.removed, expected.removed);
    ASSERT_EQ(result.isthmuses, expected.isthmuses);
    ASSERT_EQ(result.removed_by_cleanup, 0u);
    ASSERT_EQ(result.passes, expected.passes);
  }
}

TEST(SymmetricAgreementLaw, HoldsOnRandomClouds) {
  for (uint64_t seed = 0; seed < 120; seed += test::kStride) {
    SCOPED_TRACE(seed);
    const auto cloud =
        test::RandomCloud(seed, {10, 7, 9}, 0.2 + 0.6 * static_cast<double>(seed) / 119);
    const Volume object = PlacedVolume(seed, cloud);
    ExpectAgreement(object, Combination(seed, object.SortedPoints()), seed);
    if (HasFatalFailure()) return;
  }
}

TEST(SymmetricAgreementLaw, HoldsOnNoisyBlobs) {
  for (uint64_t seed = 0; seed < 120; seed += test::kStride) {
    SCOPED_TRACE(seed);
    const auto blob = test::RandomBlob(seed, {9, 8, 10}, 4, 9);
    const auto noisy = test::WithNoisyBoundary(seed, blob, 0.0016 * static_cast<double>(seed));
    const Volume object = PlacedVolume(seed, noisy);
    ExpectAgreement(object, Combination(seed, object.SortedPoints()), seed);
    if (HasFatalFailure()) return;
  }
}

class SymmetricThinningLaw : public testing::TestWithParam<uint64_t> {
 protected:
  std::vector<LatticePoint> Points() const { return test::CloudOrNoisyBlob(GetParam()); }
};

bool IsSimple(NeighborMask mask) { return test::ReferenceCondition1(mask); }

TEST_P(SymmetricThinningLaw, KeepsTheTopologyAfterAnyShell) {
  const Volume object = VolumeOfPoints(Points());
  const BettiNumbers betti = test::ReferenceBetti(test::ReferencePointSet(object));
  for (SkeletonKind kind : kKinds) {
    for (int32_t last_shell : {1, 2, 3, 0}) {
      ThinningOptions options = Symmetric(kind);
      options.last_shell = last_shell;
      const test::ReferencePointSet thin(Thin(object, options, 2).thin);
      EXPECT_EQ(test::ReferenceBetti(thin), betti) << last_shell;
    }
  }
}

TEST_P(SymmetricThinningLaw, IsthmusesStay) {
  const Volume object = VolumeOfPoints(Points());
  for (SkeletonKind kind : kKinds) {
    const ThinningResult result = Thin(object, Symmetric(kind), 3);
    for (const IsthmusBirth& isthmus : result.isthmuses) {
      EXPECT_TRUE(result.thin.Contains(isthmus.point));
      EXPECT_GE(isthmus.pass, 1);
      EXPECT_LE(isthmus.pass, static_cast<int32_t>(result.passes));
    }
    if (kind == SkeletonKind::kCurve || kind == SkeletonKind::kKernel) {
      EXPECT_TRUE(result.isthmuses.empty());
    }
  }
}

// What each kind means by thin.
TEST_P(SymmetricThinningLaw, LeavesNoSimplePointButThoseThatTheKindKeeps) {
  const Volume object = VolumeOfPoints(Points());
  const test::ReferencePointSet curve(Thin(object, Symmetric(SkeletonKind::kCurve), 2).thin);
  EXPECT_EQ(test::ReferenceSimpleNonEndPoints(curve), 0u);
  const test::ReferencePointSet kernel(Thin(object, Symmetric(SkeletonKind::kKernel), 2).thin);
  for (LatticePoint p : kernel.SortedPoints()) EXPECT_FALSE(IsSimple(kernel.NeighborsOf(p)));
  for (SkeletonKind kind : {SkeletonKind::kSurface, SkeletonKind::kIsthmusCurve}) {
    const ThinningResult result = Thin(object, Symmetric(kind), 2);
    const test::ReferencePointSet thin(result.thin);
    for (LatticePoint p : result.thin.SortedPoints()) {
      const NeighborMask mask = thin.NeighborsOf(p);
      if (kind == SkeletonKind::kSurface && std::popcount(mask) == 1) continue;
      const bool kept = std::ranges::binary_search(result.isthmuses, p, {}, &IsthmusBirth::point);
      EXPECT_TRUE(kept || !IsSimple(mask));
    }
  }
}

// A second run finds nothing to remove: all that is kept shows in what is left, but for isthmuses
// that have lost what they separated.
TEST_P(SymmetricThinningLaw, ChangesNothingTheSecondTime) {
  for (SkeletonKind kind : {SkeletonKind::kCurve, SkeletonKind::kKernel}) {
    ThinningOptions options = Symmetric(kind);
    options.stubble = StubblePolicy::kNone;
    const Volume once = Thin(VolumeOfPoints(Points()), options, 2).thin;
    EXPECT_EQ(Thin(once, options, 2).thin, once);
  }
}

TEST_P(SymmetricThinningLaw, TheKernelIsNoLargerThanAnyOtherKind) {
  const Volume object = VolumeOfPoints(Points());
  const uint64_t kernel = Thin(object, Symmetric(SkeletonKind::kKernel), 1).thin.PointCount();
  for (SkeletonKind kind : kKinds) {
    EXPECT_LE(kernel, Thin(object, Symmetric(kind), 1).thin.PointCount());
  }
}

// Colors of points and the rotation of the passes move along.
TEST_P(SymmetricThinningLaw, MovesWithTheObject) {
  const LatticePoint by = {14, 6, 24};
  ASSERT_TRUE(IsOnLattice(by) && (by.x + by.y + by.z) % 4 == 0);
  test::ExpectMovesWithTheObject(Points(), by, Symmetric(SkeletonKind::kCurve));
}

TEST_P(SymmetricThinningLaw, NeverRemovesKeptPoints) {
  const std::vector<LatticePoint> points = Points();
  for (SkeletonKind kind : kKinds) {
    ThinningOptions options = Symmetric(kind);
    options.keep = test::RandomSubset(GetParam(), points, 0.05);
    const Volume thin = Thin(VolumeOfPoints(points), options, 2).thin;
    for (LatticePoint p : options.keep) EXPECT_TRUE(thin.Contains(p));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SymmetricThinningLaw, testing::Range<uint64_t>(1, 10));

// All four kinds, of which each takes a path of its own through the kernels.
TEST(SymmetricThinning, GivesTheSameBitsOnEveryInstructionSetAndNumberOfThreads) {
  const Volume object =
      VolumeOfPoints(test::WithNoisyBoundary(5, test::RandomBlob(11, {40, 40, 40}, 7, 16), 0.02));
  for (SkeletonKind kind : kKinds) {
    const Volume expected = Thin(object, Symmetric(kind), 1).thin;
    for (const std::string& name : exec::SupportedInstructionSets()) {
      SCOPED_TRACE(name);
      ASSERT_TRUE(exec::ChooseInstructionSet(name));
      for (int threads : {1, 2, 5, 8}) {
        EXPECT_TRUE(Thin(object, Symmetric(kind), threads).thin == expected) << threads;
      }
    }
    exec::ChooseInstructionSet("");
  }
}

int EndsOf(const test::ReferencePointSet& thin) {
  int ends = 0;
  for (LatticePoint p : thin.SortedPoints()) {
    ends += std::popcount(thin.NeighborsOf(p)) == 1;
  }
  return ends;
}

// Where a plain bar loses everything with other tools.
TEST(SymmetricThinning, LeavesOneCurveAlongABar) {
  const Volume thin = Thin(test::FullVolume({4, 4, 100}), Symmetric(SkeletonKind::kCurve), 1).thin;
  const test::ReferencePointSet points(thin);
  EXPECT_EQ(test::ReferenceBetti(points), (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(EndsOf(points), 2);
  const std::vector<LatticePoint> sorted = thin.SortedPoints();
  EXPECT_GT(sorted.back().z - sorted.front().z, 180);  // of 200
}

TEST(SymmetricThinning, LosesNoCube) {
  for (SkeletonKind kind : kKinds) {
    for (int edge : {1, 2, 4, 7}) {
      const Volume thin = Thin(test::FullVolume({edge, edge, edge}), Symmetric(kind), 1).thin;
      const test::ReferencePointSet points(thin);
      EXPECT_EQ(test::ReferenceBetti(points), (BettiNumbers{1, 0, 0})) << edge;
      if (kind == SkeletonKind::kKernel) {
        EXPECT_EQ(thin.PointCount(), 1u);
      }
    }
  }
}

// A plate: the surface skeleton keeps its extent, the curve skeleton does not keep its area.
TEST(SymmetricThinning, TheSurfaceSkeletonOfAPlateIsASheet) {
  const Volume plate = test::FullVolume({30, 24, 5});
  const uint64_t surface = Thin(plate, Symmetric(SkeletonKind::kSurface), 1).thin.PointCount();
  const uint64_t curve = Thin(plate, Symmetric(SkeletonKind::kCurve), 1).thin.PointCount();
  EXPECT_GT(surface, 400u);
  EXPECT_LT(surface, 2000u);
  EXPECT_LT(curve, 150u);
}

TEST(SymmetricThinning, OtherMethodsRefuseOtherKinds) {
  for (ThinningMethod method :
       {ThinningMethod::kDirectional, ThinningMethod::kDirectionalAlternating}) {
    for (SkeletonKind kind : kKinds) {
      const absl::Status status = CheckThinningOptions({.method = method, .kind = kind});
      EXPECT_EQ(status.ok(), kind == SkeletonKind::kCurve) << status;
      if (status.ok()) continue;
      EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    }
  }
}

// One worker goes through an object slab by slab, and each of its passes is at several slabs at
// once.
TEST(SymmetricSlabs, GiveWhatStepsOfTheWholeObjectGive) {
  for (uint64_t seed = 0; seed < 3; ++seed) {
    const Volume tall = VolumeOfPoints(test::RandomBlob(seed, {40, 40, 150}, 5, 60));
    for (const SkeletonKind kind : kKinds) {
      const ThinningResult expected = Thin(tall, Symmetric(kind), 3);
      const ThinningResult result = Thin(tall, Symmetric(kind), 1);
      EXPECT_EQ(result.thin, expected.thin);
      EXPECT_EQ(result.isthmuses, expected.isthmuses);
      EXPECT_EQ(result.passes, expected.passes);
    }
  }
}

// In a team, slabs run ahead of the steps of their worker's borders.
TEST(SymmetricSlabs, RunAheadOfBorders) {
  const auto blob = test::RandomBlob(7, {64, 64, 500}, 400, 7);
  const Volume tall = VolumeOfPoints(test::WithNoisyBoundary(7, blob, 0.1));
  for (const SkeletonKind kind : {SkeletonKind::kCurve, SkeletonKind::kSurface}) {
    const test::ReferenceThinning expected = test::ReferenceThinCounted(tall, Symmetric(kind));
    for (const int threads : {2, 3, 5, 8}) {
      const ThinningResult result = Thin(tall, Symmetric(kind), threads);
      EXPECT_TRUE(result.thin.SortedPoints() == expected.thin) << threads << " threads";
      EXPECT_EQ(result.isthmuses, expected.isthmuses);
      EXPECT_EQ(result.passes, expected.passes);
    }
  }
}

// Layers without bricks, above any number of bricks.
TEST(SymmetricSlabs, EndAtEveryGap) {
  std::vector<LatticePoint> points;
  for (int32_t bricks = 1; bricks <= 70; ++bricks) {
    points.push_back({32 * bricks, 0, 0});
    std::vector<LatticePoint> with_gap = points;
    with_gap.push_back({32, 0, 200});
    const Volume apart = VolumeOfPoints(with_gap);
    ASSERT_EQ(apart.brick_count(), static_cast<size_t>(bricks) + 1);
    EXPECT_EQ(Thin(apart, Symmetric(SkeletonKind::kCurve), 1).thin, apart);
  }
}

}  // namespace
}  // namespace bccskel::symmetric_agreement
