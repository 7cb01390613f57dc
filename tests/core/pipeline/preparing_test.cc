#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "core/pipeline/notes.h"
#include "core/pipeline/option_words.h"
#include "core/pipeline/skeletonize.h"
#include "tests/core/pipeline/skeleton_of.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_conditions.h"
#include "tests/support/volume_where.h"

namespace bccskel::preparing {
namespace {

using test::SkeletonOf;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

BettiNumbers BettiOf(const Volume& object) {
  return test::ReferenceBetti(test::ReferencePointSet(object));
}

Volume HollowBall() {
  return test::VolumeWhere({24, 24, 24}, [](int32_t x, int32_t y, int32_t z) {
    const double r = std::hypot(x - 24, y - 24, z - 24);
    return r < 20 && r > 9;
  });
}

const PreparingOptions kAll = {.denoise_passes = 1,
                               .cavities = CavityFilling::kOn,
                               .min_component_points = 10,
                               .components = KeptComponents::kLargest};

TEST(SkeletonizePrepared, CertifiesTheObjectAsGivenAndAsPrepared) {
  for (uint64_t seed = 0; seed < 4; ++seed) {
    const auto blob = test::RandomBlob(seed, {30, 30, 30}, 8, 10);
    const Volume object = VolumeOfPoints(test::WithNoisyBoundary(seed, blob, 0.1));
    exec::UnlimitedMemory memory;
    const Volume prepared = Prepare(object, kAll, memory, {})->object;
    const SkeletonizeResult result = SkeletonOf(object, {.preparing = kAll});
    EXPECT_EQ(result.certificate.unprepared, BettiOf(object));
    EXPECT_EQ(result.certificate.Given(), BettiOf(object));
    EXPECT_EQ(result.certificate.input, BettiOf(prepared));
    EXPECT_EQ(result.certificate.skeleton, BettiOf(result.thin));
    EXPECT_EQ(result.object_points, prepared.PointCount());
    EXPECT_EQ(result.sha256, SkeletonOf(prepared, {}).sha256);
    EXPECT_EQ(result.preparing.size(), 4u);
  }
}

TEST(SkeletonizePrepared, SaysNothingOfPreparingThatWasNotWanted) {
  const SkeletonizeResult result = SkeletonOf(HollowBall(), {});
  EXPECT_EQ(result.certificate.unprepared, std::nullopt);
  EXPECT_EQ(result.certificate.Given(), result.certificate.input);
  EXPECT_THAT(result.preparing, IsEmpty());
}

TEST(SkeletonizePrepared, RefusesBadOptionsAndTooLargeAnObject) {
  const auto code = [](const PreparingOptions& preparing) {
    return Skeletonize(HollowBall(), {.preparing = preparing}, {}).status().code();
  };
  EXPECT_EQ(code({.denoise_passes = -1}), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(code({.cavities = CavityFilling::kOn, .max_bricks = 1}),
            absl::StatusCode::kResourceExhausted);
}

TEST(NotesOn, NameTheClosedSurfacesAndTheOptionAgainstThem) {
  EXPECT_THAT(NotesOn(SkeletonOf(HollowBall(), {})),
              ElementsAre(HasSubstr("1 cavity leaves a closed surface")));
  EXPECT_THAT(NotesOn(SkeletonOf(HollowBall(), {})), ElementsAre(HasSubstr("--fill-cavities")));
  const SkeletonizeOptions surface = {
      .thinning = {.method = ThinningMethod::kSymmetric, .kind = SkeletonKind::kSurface}};
  EXPECT_THAT(NotesOn(SkeletonOf(HollowBall(), surface)), IsEmpty());
  EXPECT_THAT(NotesOn(SkeletonOf(HollowBall(), {.preparing = kAll})),
              ElementsAre(HasSubstr("cavities 1 -> 0")));
}

TEST(NotesOn, SayWhenNothingIsLeft) {
  EXPECT_THAT(
      NotesOn(SkeletonOf(HollowBall(), {.preparing = {.min_component_points = 1 << 20}})),
      ElementsAre("nothing is left of the object after preparing: 1 small component dropped"));
  EXPECT_THAT(NotesOn(SkeletonOf(Volume(), {})), ElementsAre("the object has no points"));
}

TEST(NotesOn, NameTheKindForPlatesAndShells) {
  const auto plate = [](int32_t width) {
    const LatticeBox box = {{4, 4, 4}, {115, 2 * width - 5, 15}};
    return test::VolumeWhere({60, width, 10}, [&](int32_t x, int32_t y, int32_t z) {
      return box.Contains(LatticePoint{x, y, z});
    });
  };
  EXPECT_THAT(
      NotesOn(SkeletonOf(plate(60), {})),
      ElementsAre(AllOf(HasSubstr("% of the object, as in plates"), HasSubstr("--kind surface"))));
  EXPECT_THAT(NotesOn(SkeletonOf(plate(12), {})), IsEmpty());
  const SkeletonizeOptions surface = {
      .thinning = {.method = ThinningMethod::kSymmetric, .kind = SkeletonKind::kSurface}};
  EXPECT_THAT(NotesOn(SkeletonOf(plate(60), surface)), IsEmpty());
}

TEST(NotesOn, NameTheOptionsAgainstSpecks) {
  const auto specks = [](int32_t number) {
    VolumeBuilder points({400, 400, 400});
    for (int32_t n = 0; n < number; ++n) points.Add({8 * (n % 40), 8 * (n / 40), 0});
    return *std::move(points).Build();
  };
  EXPECT_THAT(NotesOn(SkeletonOf(specks(1000), {})),
              ElementsAre("the object has 1000 components, as noise produces specks; "
                          "--min-component 200 drops small ones, --keep-largest all but one"));
  EXPECT_THAT(NotesOn(SkeletonOf(specks(999), {})), IsEmpty());
}

TEST(NotesOn, SayWhySimplePointsAreLeft) {
  const SkeletonizeOptions early = {
      .thinning = {.method = ThinningMethod::kSymmetric, .last_shell = 2}};
  EXPECT_THAT(NotesOn(SkeletonOf(VolumeOfPoints(test::RandomBlob(1, {30, 30, 30}, 4, 12)), early)),
              ElementsAre(HasSubstr("told to stop")));
}

// Isthmuses stay though some become simple later, and kernels have no end points.
TEST(SimplePointsLeft, AreThoseThatTheKindOfSkeletonDoesNotKeep) {
  uint64_t simple = 0;
  for (SkeletonKind kind : {SkeletonKind::kCurve, SkeletonKind::kSurface, SkeletonKind::kKernel,
                            SkeletonKind::kIsthmusCurve}) {
    for (uint64_t seed = 0; seed < 4; ++seed) {
      const auto blob = test::RandomBlob(seed, {30, 30, 30}, 8, 10);
      const Volume object = VolumeOfPoints(test::WithNoisyBoundary(seed, blob, 0.1));
      const SkeletonizeResult result =
          SkeletonOf(object, {.thinning = {.method = ThinningMethod::kSymmetric, .kind = kind}});
      EXPECT_EQ(result.certificate.simple_points_left, 0u) << static_cast<int>(kind);
      const test::ReferencePointSet thin(result.thin);
      result.thin.ForEachPoint([&](LatticePoint p) {
        simple += test::ReferenceCondition1(thin.NeighborsOf(p)) ? 1u : 0u;
      });
    }
  }
  EXPECT_GT(simple, 0u);
}

TEST(SimplePointsLeft, AreNotThoseThatTheCallerKeeps) {
  const Volume object = VolumeOfPoints(test::RandomBlob(3, {20, 20, 20}, 3, 8));
  SkeletonizeOptions options;
  options.thinning.keep = object.SortedPoints();
  const SkeletonizeResult kept = SkeletonOf(object, options);
  EXPECT_EQ(kept.skeleton_points, object.PointCount());
  EXPECT_EQ(kept.certificate.simple_points_left, 0u);
  EXPECT_THAT(kept.options.thinning.keep, IsEmpty());
}

TEST(OptionFacts, NameEveryOptionOnce) {
  const std::vector<OptionFact> facts = FactsOf(SkeletonizeOptions{.preparing = kAll});
  std::set<std::string> names;
  for (const OptionFact& fact : facts) {
    EXPECT_TRUE(names.insert(fact.name).second) << fact.name;
    EXPECT_FALSE(fact.value.empty()) << fact.name;
  }
  EXPECT_EQ(facts.front().value, "1");
  EXPECT_EQ(facts[1].value, "filled");
  EXPECT_EQ(facts[8].value, "symmetric");
}

}  // namespace
}  // namespace bccskel::preparing
