#include "core/prepare/prepare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/prepare/brick_sets.h"
#include "core/prepare/fill_cavities.h"
#include "tests/core/prepare/reference_prepare.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/sanitized.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

using test::Points;
using test::RandomCloud;
using test::ReferenceBetti;
using test::ReferencePointSet;

const PreparingOptions kFill = {.cavities = CavityFilling::kOn};
const PreparingOptions kLargest = {.components = KeptComponents::kLargest};

PreparedObject Prepared(const Volume& object, const PreparingOptions& options, int threads = 1) {
  test::TeamContext context(threads);
  exec::UnlimitedMemory memory;
  auto prepared = Prepare(object, options, memory, context);
  EXPECT_TRUE(prepared.ok()) << prepared.status();
  return *std::move(prepared);
}
Points PointsAfter(const Points& points, const PreparingOptions& options) {
  return Prepared(VolumeOfPoints(points), options).object.SortedPoints();
}

std::vector<Points> RandomObjects() {
  std::vector<Points> objects;
  for (uint64_t seed = 0; seed < 60; seed += test::kStride) {
    const double density = 0.05 + 0.9 * static_cast<double>(seed % 20) / 19;
    objects.push_back(test::Sorted(RandomCloud(seed, {35, 9, 10}, density)));
  }
  for (uint64_t seed = 0; seed < 6; seed += test::kStride) {
    const Points blob = test::RandomBlob(seed, {60, 30, 30}, 4, 30);
    const ReferencePointSet solid(blob);
    Points border;
    for (LatticePoint p : blob) {
      if (solid.NeighborsOf(p) != kAllNeighbors) border.push_back(p);
    }
    objects.push_back(test::Sorted(border));
  }
  return objects;
}

TEST(BricksAroundLaw, AreThoseUpToTheReachAndNoMoreThanStated) {
  for (const BrickCoordinates reach : {BrickCoordinates{0, 0, 0}, {1, 2, 3}, {5, 1, 0}}) {
    for (uint64_t seed = 0; seed < 12; seed += test::kStride) {
      VolumeBuilder builder({1000, 300, 400});
      for (LatticePoint p : RandomCloud(seed, {24, 24, 12}, seed % 2 == 0 ? 0.003 : 0.1)) {
        builder.Add(
            {p.x + 2 * kBrickX * 7 * (p.y % 5 + 1), 100 + 7 * p.y - 6 * (p.x & 1), p.z + 200});
      }
      const Volume object = *std::move(builder).Build();
      std::set<BrickKey> expected;
      for (BrickKey key : object.keys()) {
        const BrickCoordinates at = key.coordinates();
        for (int32_t z = -reach.bz; z <= reach.bz; ++z) {
          for (int32_t y = -reach.by; y <= reach.by; ++y) {
            for (int32_t x = -reach.bx; x <= reach.bx; ++x) {
              for (const Sublattice s : kSublattices) {
                expected.insert(BrickKey({at.bx + x, at.by + y, at.bz + z, s}));
              }
            }
          }
        }
      }
      const std::vector<BrickKey> around = BricksAround(object, reach);
      EXPECT_TRUE(std::ranges::equal(around, expected)) << seed;
      EXPECT_LE(around.size(), MostBricksAround(object, reach)) << seed;
    }
  }
  EXPECT_EQ(MostBricksAround(Volume(), {1, 1, 1}), 0u);
}

TEST(FillCavitiesLaw, FillsWhatAFloodFromOutsideDoesNotReach) {
  for (const Points& points : RandomObjects()) {
    const Points filled = PointsAfter(points, kFill);
    ASSERT_EQ(filled, test::ReferenceFilled(points));
    EXPECT_EQ(ReferenceBetti(ReferencePointSet(filled)).cavities, 0);
  }
}

TEST(FillCavitiesLaw, CountsTheCavitiesAndPointsAndDoesNothingTheSecondTime) {
  for (const Points& points : RandomObjects()) {
    const PreparedObject once = Prepared(VolumeOfPoints(points), kFill);
    const PreparingStep step = {PreparingStepKind::kFillCavities,
                                static_cast<uint64_t>(once.before.cavities),
                                once.object.PointCount() - points.size(), 0};
    EXPECT_EQ(once.steps, std::vector{step});
    const PreparedObject twice = Prepared(once.object, kFill);
    EXPECT_TRUE(twice.object == once.object);
    EXPECT_EQ(twice.steps, std::vector{PreparingStep{PreparingStepKind::kFillCavities}});
  }
}

// Cavities of single points hold no object and have no handles.
TEST(FillCavitiesLaw, OfSinglePointsLeavesComponentsAndLoopsAlone) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const Volume torus = test::VolumeWhere({26, 26, 26}, [](double x, double y, double z) {
      return std::hypot(std::hypot(x - 26, y - 26) - 14, z - 26) <= 8;
    });
    Points points = torus.SortedPoints();
    const ReferencePointSet solid(points);
    VolumeBuilder holed(torus.extent());
    for (LatticePoint p : points) holed.Add(p);
    int64_t holes = 0;
    for (LatticePoint p : test::RandomSubset(seed, points, 0.5)) {
      const auto whole = [&](LatticePoint step) {
        return solid.NeighborsOf(p + step) == kAllNeighbors;
      };
      if (p.x % 4 != 0 || p.y % 4 != 0 || p.z % 4 != 0) continue;
      if (!whole({0, 0, 0}) || !std::ranges::all_of(kDirections14, whole)) continue;
      holed.Remove(p);
      ++holes;
    }
    ASSERT_GT(holes, 0);
    const PreparedObject prepared = Prepared(*std::move(holed).Build(), kFill);
    EXPECT_EQ(prepared.before, (BettiNumbers{1, 1, holes}));
    EXPECT_EQ(test::BettiOf(prepared.object), (BettiNumbers{1, 1, 0}));
    EXPECT_EQ(prepared.object.SortedPoints(), points);
  }
}

// The shell's inside has bricks that are not stored.
TEST(FillCavities, OfAHollowBallGivesTheBall) {
  const auto ball = [](double inner) {
    return test::VolumeWhere({122, 122, 122}, [inner](double x, double y, double z) {
      const double r = std::hypot(x - 120, y - 120, z - 120);
      return r <= 118 && r >= inner;
    });
  };
  const Volume hollow = ball(113), solid = ball(0);
  ASSERT_LT(hollow.brick_count(), solid.brick_count());
  const PreparedObject prepared = Prepared(hollow, kFill);
  EXPECT_TRUE(prepared.object == solid);
  EXPECT_EQ(*BricksWithCavitiesFilled(hollow, {}), solid.brick_count());
  EXPECT_EQ(*BricksWithCavitiesFilled(solid, {}), solid.brick_count());
}

TEST(FillCavities, MakesNoObjectOfMoreBricksThanAllowed) {
  const Volume hollow = test::VolumeWhere({60, 60, 60}, [](double x, double y, double z) {
    const double r = std::hypot(x - 60, y - 60, z - 60);
    return r <= 58 && r >= 54;
  });
  const uint64_t needed = *BricksWithCavitiesFilled(hollow, {});
  ASSERT_GT(needed, hollow.brick_count());
  EXPECT_TRUE(FillCavities(hollow, needed, {}).ok());
  const auto refused = FillCavities(hollow, needed - 1, {});
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kResourceExhausted);
}

TEST(DropSmallComponentsLaw, KeepsTheComponentsOfAtLeastSoManyPoints) {
  for (const Points& points : RandomObjects()) {
    const std::vector<Points> components = test::ReferenceComponents(points);
    for (uint64_t least : {1U, 2U, 5U, 40U}) {
      Points expected;
      uint64_t dropped = 0;
      for (const Points& component : components) {
        if (component.size() >= least) {
          expected.insert(expected.end(), component.begin(), component.end());
        } else {
          ++dropped;
        }
      }
      const PreparedObject prepared =
          Prepared(VolumeOfPoints(points), {.min_component_points = least});
      ASSERT_EQ(prepared.object.SortedPoints(), test::Sorted(expected));
      const PreparingStep step = {PreparingStepKind::kDropSmallComponents, dropped, 0,
                                  points.size() - expected.size()};
      EXPECT_EQ(prepared.steps, std::vector{step});
    }
  }
}

// Two points take the volume of a cubic cell.
TEST(DropSmallComponents, TakesVolumesInWorldUnits) {
  const Points points = {{2, 2, 2}, {3, 3, 3}, {4, 4, 4}, {20, 2, 2}, {21, 3, 3}};
  const Volume object = test::VolumeWith(points, {20, 4, 4}, {.spacing = {0.5, 1, 2}});
  const auto left = [&](double volume) {
    return Prepared(object, {.min_component_volume = volume}).object.PointCount();
  };
  EXPECT_EQ(left(1.0), 5u);
  EXPECT_EQ(left(1.01), 3u);
  EXPECT_EQ(left(1.5), 3u);
  EXPECT_EQ(left(1.51), 0u);
  EXPECT_EQ(left(1e300), 0u);
}

TEST(KeepLargestComponentLaw, KeepsAComponentOfTheMostPoints) {
  for (const Points& points : RandomObjects()) {
    const std::vector<Points> components = test::ReferenceComponents(points);
    const Points kept = PointsAfter(points, kLargest);
    const auto bigger = [&](const Points& c) { return c.size() > kept.size(); };
    EXPECT_TRUE(std::ranges::none_of(components, bigger));
    EXPECT_TRUE(std::ranges::find(components, kept) != components.end());
  }
}

// Points of one brick, so that components are fragments.
TEST(KeepLargestComponent, OfEqualOnesTakesTheFirstInBrickOrderForAnyNumberOfThreads) {
  const Points far = {{2, 2, 2},  {4, 2, 2},  {10, 2, 2}, {12, 2, 2},
                      {18, 4, 4}, {20, 4, 4}, {70, 2, 2}};
  const Points first = {{2, 2, 2}, {4, 2, 2}};
  EXPECT_EQ(PointsAfter(far, kLargest), first);
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const Volume object = VolumeOfPoints(RandomCloud(seed, {64, 40, 40}, 0.02));
    const PreparedObject expected = Prepared(object, kLargest);
    for (int threads : {2, 5}) {
      EXPECT_TRUE(Prepared(object, kLargest, threads).object == expected.object);
    }
  }
}

TEST(PrepareLaw, DoesAllStepsInTheirOrderForAnyNumberOfThreads) {
  const PreparingOptions all = {.denoise_passes = 2,
                                .cavities = CavityFilling::kOn,
                                .min_component_points = 4,
                                .components = KeptComponents::kLargest};
  for (uint64_t seed = 0; seed < 12; seed += test::kStride) {
    const Points points = test::Sorted(RandomCloud(seed, {40, 16, 16}, 0.42 + 0.01 * double(seed)));
    Points expected = test::ReferenceDenoised(test::ReferenceDenoised(points));
    expected = test::ReferenceFilled(expected);
    std::vector<Points> components = test::ReferenceComponents(expected);
    std::erase_if(components, [](const Points& c) { return c.size() < 4; });
    ASSERT_FALSE(components.empty());
    size_t largest = 0;
    for (const Points& c : components) largest = std::max(largest, c.size());
    const PreparedObject prepared = Prepared(VolumeOfPoints(points), all);
    const Points kept = prepared.object.SortedPoints();
    EXPECT_EQ(kept.size(), largest);
    EXPECT_TRUE(std::ranges::find(components, kept) != components.end());
    EXPECT_EQ(prepared.before, ReferenceBetti(ReferencePointSet(points)));
    ASSERT_EQ(prepared.steps.size(), 4u);
    uint64_t count = points.size();
    for (const PreparingStep& step : prepared.steps) {
      count += step.points_added - step.points_removed;
    }
    EXPECT_EQ(count, largest);
    const PreparedObject threaded = Prepared(VolumeOfPoints(points), all, 3);
    EXPECT_TRUE(threaded.object == prepared.object);
    EXPECT_EQ(threaded.steps, prepared.steps);
  }
}

TEST(Prepare, WithoutWishesChangesNothing) {
  const Volume object = VolumeOfPoints(RandomCloud(1, {20, 20, 20}, 0.4));
  EXPECT_FALSE(PreparingOptions().Wanted());
  const PreparedObject prepared = Prepared(object, {});
  EXPECT_TRUE(prepared.object == object);
  EXPECT_TRUE(prepared.steps.empty());
}

TEST(Prepare, OfNothingIsNothing) {
  const PreparedObject prepared = Prepared(Volume(), {.denoise_passes = 1,
                                                      .cavities = CavityFilling::kOn,
                                                      .min_component_points = 1,
                                                      .components = KeptComponents::kLargest});
  EXPECT_TRUE(prepared.object.empty());
}

TEST(Prepare, RefusesOptionsOutOfRange) {
  const auto code = [](const PreparingOptions& options) {
    return CheckPreparingOptions(options).code();
  };
  EXPECT_EQ(code({.denoise_passes = -1}), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(code({.denoise_passes = kMaxDenoisePasses + 1}), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(code({.min_component_volume = -1}), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(code({.min_component_volume = std::numeric_limits<double>::quiet_NaN()}),
            absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(code({.denoise_passes = kMaxDenoisePasses}), absl::StatusCode::kOk);
}

TEST(Prepare, StopsWhenTheJobIsCancelled) {
  const exec::Context context = test::Stopped();
  const Volume object = VolumeOfPoints(RandomCloud(3, {20, 20, 20}, 0.5));
  for (const PreparingOptions& options : {kFill, kLargest, PreparingOptions{1}}) {
    exec::UnlimitedMemory memory;
    EXPECT_EQ(Prepare(object, options, memory, context).status().code(),
              absl::StatusCode::kCancelled);
  }
}

}  // namespace
}  // namespace bccskel
