#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>
#include <vector>

#include "core/pipeline/skeletonize.h"
#include "core/pruning/rib_finder.h"
#include "core/shapes/shapes.h"
#include "tests/core/pruning/raw_curves.h"
#include "tests/core/pruning/simple_noise.h"

namespace bccskel {
namespace {

using test::RawCurves;

// A flat limb along x, in lattice units: 240 long, 56 wide and 10 thick.
constexpr int32_t kLength = 240, kMiddle = 70, kHalfWidth = 28, kThickness = 10;

// Something that sticks out of the limb's upper rim, as thick as the limb.
struct Arm {
  int32_t x = 0;  // of its middle
  int32_t half_width = 0;
  int32_t length = 0;
};

// A rim with teeth up to `height` high and 6 wide on both sides.
Volume FlatLimb(int32_t height, const std::vector<Arm>& arms, const Placement& placement = {}) {
  std::mt19937_64 random(5);
  std::vector<int32_t> upper, lower;
  for (int32_t x = 0; x < kLength; x += 6) {
    for (auto* rim : {&upper, &lower}) {
      rim->push_back(kHalfWidth -
                     static_cast<int32_t>(random() % static_cast<uint64_t>(height + 1)));
    }
  }
  VolumeBuilder builder({kLength / 2, kMiddle, kThickness / 2}, placement);
  for (int32_t z = 0; z < kThickness; ++z) {
    for (int32_t y = 0; y < 2 * kMiddle; ++y) {
      for (int32_t x = 0; x < kLength; ++x) {
        const auto tooth = static_cast<size_t>(x / 6);
        const bool in_limb = y <= kMiddle + upper[tooth] && y >= kMiddle - lower[tooth];
        const bool in_arm = std::ranges::any_of(arms, [&](const Arm& arm) {
          return std::abs(x - arm.x) <= arm.half_width && y >= kMiddle &&
                 y <= kMiddle + kHalfWidth + arm.length;
        });
        if ((in_limb || in_arm) && IsOnLattice({x, y, z})) builder.Add({x, y, z});
      }
    }
  }
  return *std::move(builder).Build();
}

size_t EndsOf(const Volume& object, const PruningOptions& pruning = {}) {
  SkeletonizeOptions options;
  options.pruning = pruning;
  const SkeletonGraph graph = Skeletonize(object, options, {})->graph;
  return static_cast<size_t>(std::ranges::count(graph.nodes, NodeKind::kEnd, &SkeletonNode::kind));
}

// Length tells no ribs from limbs, so it shows what is there.
size_t EndsWithRibs(const Volume& object) { return EndsOf(object, {PruningRule::kLength, 3}); }

TEST(Ribs, AreTakenOffFlatLimbsWithRoughRims) {
  for (int32_t height : {0, 4, 6, 8, 10}) {
    SCOPED_TRACE(height);
    const Volume limb = FlatLimb(height, {});
    EXPECT_EQ(EndsOf(limb), height < 10 ? 2u : 3u);  // a torn rim keeps a rib
    EXPECT_GE(EndsWithRibs(limb), height < 8 ? 2u : 12u);
  }
}

// In lattice coordinates the limb of the last case would be too narrow.
TEST(Ribs, AreMeasuredAsTheyLieInTheWorld) {
  struct Case {
    std::array<double, 3> spacing;
    int32_t height;
  };
  for (const Case& c :
       {Case{{1.0, 1.0, 1.5}, 6}, Case{{1.0, 2.0, 1.0}, 6}, Case{{1.0, 3.0, 1.0}, 8}}) {
    const Volume limb = FlatLimb(c.height, {}, {.spacing = c.spacing});
    EXPECT_EQ(EndsOf(limb), 2u);
    EXPECT_GE(EndsWithRibs(limb), 7u);
  }
}

TEST(Ribs, AreNotTheArmsAndEarsOfFlatLimbs) {
  for (int32_t height : {0, 4, 8}) {
    for (int32_t half_width : {5, 9}) {
      for (int32_t length : {20, 28, 40}) {
        SCOPED_TRACE(testing::Message() << height << ' ' << half_width << ' ' << length);
        const Arm left = {.x = 95, .half_width = half_width, .length = length};
        const Arm right = {.x = 145, .half_width = half_width, .length = length};
        EXPECT_EQ(EndsOf(FlatLimb(height, {left, right})), 4u);
      }
    }
  }
}

TEST(Ribs, StayWhereTheMarginIsSmall) {
  const Volume limb = FlatLimb(8, {});
  EXPECT_GE(EndsOf(limb, {PruningRule::kSlope, 1}), 12u);
  EXPECT_EQ(EndsOf(limb, {PruningRule::kSlope, kDefaultSlopeMargin}), 2u);
}

TEST(Ribs, HaveLevelsThatTellWhatEveryMarginLeaves) {
  const RawCurves raw(FlatLimb(8, {}), SkeletonKind::kCurve);
  const PruningLevels levels = raw.PrunedBy(PruningRule::kNone, 0).levels;
  for (double margin : {1.0, 3.0, 3.6, 3.8, 3.9, 4.0, 16.0}) {
    const Volume pruned = raw.PrunedBy(PruningRule::kSlope, margin).thin;
    levels.ForEach([&](LatticePoint p, double level) {
      ASSERT_EQ(pruned.Contains(p), level >= margin) << margin;
    });
  }
}

// The rule of length knows nothing of ribs, so what it leaves has not lost any.
TEST(Ribs, AreNoLimbsOfRoundThings) {
  for (Shape shape : {Shape::kTree, Shape::kHorse, Shape::kTubes}) {
    const Volume clean = *GenerateShape(shape, {.points = 60'000});
    for (double noise : {0.0, 0.05}) {
      const Volume object = noise == 0 ? clean : test::WithSimpleNoise(clean, noise, 1);
      const RawCurves raw(object, SkeletonKind::kCurve);
      const PrunedSkeleton pruned = raw.PrunedBy(PruningRule::kRelativeLength, 1.5);
      const ThinSet set({pruned.thin, pruned.radii});
      RibFinder ribs(object);
      for (LatticePoint end : set.Ends()) {
        const FreeBranch branch = BranchFrom(set, end);
        EXPECT_FALSE(branch.junction.has_value() && ribs.IsRib(set, branch));
      }
    }
  }
}

}  // namespace
}  // namespace bccskel
