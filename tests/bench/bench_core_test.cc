#include "client/cli/bench_core.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/bench/reference_skeleton.h"
#include "tests/support/contexts.h"

namespace bccskel::cli {
namespace {

using testing::HasSubstr;

Volume Object(std::string_view name, uint64_t points) {
  auto object = MakeBenchObject(name, points);
  EXPECT_TRUE(object.ok()) << object.status();
  return *std::move(object);
}

const SkeletonizeOptions kPaper = {.thinning = {.method = ThinningMethod::kDirectional},
                                   .distance = DistanceKind::kChamfer};

double Fill(const Volume& object) {
  return static_cast<double>(object.PointCount()) /
         static_cast<double>(object.extent().PointCount());
}

TEST(SpreadOf, TakesTheMiddleOfAnOddNumberOfValuesAndTheMeanOfTwoElse) {
  const Spread odd = SpreadOf({5, 1, 3});
  EXPECT_EQ(odd.min, 1);
  EXPECT_EQ(odd.median, 3);
  EXPECT_EQ(odd.max, 5);
  EXPECT_EQ(SpreadOf({4, 1, 3, 8}).median, 3.5);
  EXPECT_EQ(SpreadOf({7}).median, 7);
}

TEST(BenchObjects, HaveTheWantedNumberOfPointsWithin3Percent) {
  for (const char* name : kBenchObjects) {
    EXPECT_NEAR(static_cast<double>(Object(name, 50'000).PointCount()), 50'000, 1'500) << name;
  }
}

TEST(BenchObjects, LeaveTheirBoxAsEmptyAsTheirNamesSay) {
  EXPECT_NEAR(Fill(Object("tubes", 850'000)), 0.014, 0.004);
  EXPECT_NEAR(Fill(Object("thin-tubes", 850'000)), 0.0001, 0.00003);
}

TEST(BenchObjects, RefuseANameThatNoObjectHas) {
  const auto object = MakeBenchObject("teapot", 50'000);
  EXPECT_EQ(object.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(object.status().message()), HasSubstr("teapot"));
  EXPECT_THAT(std::string(object.status().message()), HasSubstr("thin-tubes"));
}

TEST(MeasureCore, GivesTheReferencesSkeletonOfEveryObject) {
  for (const char* name : kBenchObjects) {
    if (std::string_view(name) == "thin-tubes") continue;  // box too large for the reference here
    const Volume object = Object(name, 10'000);
    const auto measured = MeasureCore(object, kPaper, 1, {});
    ASSERT_TRUE(measured.ok()) << measured.status();
    const auto expected = test::ReferenceDigest(object);
    ASSERT_TRUE(expected.ok()) << expected.status();
    EXPECT_EQ(measured->sha256, *expected) << name;
  }
}

TEST(MeasureCore, HasOneTimingForEachWarmRunAndStagesThatAddUpToNoMoreThanTheWhole) {
  const Volume object = Object("torus", 20'000);
  const auto measured = MeasureCore(object, {}, 3, {});
  ASSERT_TRUE(measured.ok()) << measured.status();
  EXPECT_EQ(measured->points, object.PointCount());
  EXPECT_EQ(measured->bricks, object.brick_count());
  ASSERT_EQ(measured->warm.size(), 3u);
  for (const StageTimings& run : measured->warm) {
    StageTimings::Duration sum{0};
    for (const Stage& stage : kStages) {
      // Nothing is prepared unless it is asked for; symmetric thinning leaves nothing to clean up.
      const bool is_idle =
          stage.time == &StageTimings::preparing || stage.time == &StageTimings::cleanup;
      EXPECT_EQ((run.*stage.time).count() == 0, is_idle) << stage.name;
      sum += run.*stage.time;
    }
    EXPECT_LE(sum, run.total);
    EXPECT_LT(CoreTime(run), run.total);
  }
}

// Distances alone are two bytes for each point of a brick; a hundred would be a mistake of units.
TEST(MeasureCore, CountsTheMemoryOfTheDistancesAtLeast) {
  const Volume object = Object("ball", 2'000'000);
  const auto measured = MeasureCore(object, kPaper, 1, {});
  ASSERT_TRUE(measured.ok()) << measured.status();
  if (!measured->peak_bytes.has_value()) GTEST_SKIP() << "no high-water mark on this system";
  const uint64_t lattice_points = object.brick_count() * kBrickPoints;
  EXPECT_GT(*measured->peak_bytes, lattice_points);
  EXPECT_LT(*measured->peak_bytes, 100 * lattice_points);
}

TEST(MeasureCore, StopsWhenAskedTo) {
  const exec::Context context = test::Stopped();
  EXPECT_EQ(MeasureCore(Object("ball", 10'000), {}, 1, context).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace bccskel::cli
