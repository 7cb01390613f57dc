#include "core/distance/exact_radius.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/exec/instruction_sets.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/sanitized.h"
#include "tests/support/volume_where.h"

namespace bccskel::exact_radius {
namespace {

Volume Placed(const std::vector<LatticePoint>& points, const std::array<double, 3>& spacing) {
  return test::VolumeWith(points, {80, 80, 80}, {.spacing = spacing});
}

class ExactRadiusLaw : public testing::TestWithParam<uint64_t> {};

TEST_P(ExactRadiusLaw, IsFoundWithTheSameBitsWhateverTheField) {
  const uint64_t seed = GetParam();
  const LatticeExtent extent = {70, 40, 40};
  for (const auto& points :
       {test::RandomBlob(seed, extent, 4, 35), test::RandomCloud(seed, {40, 20, 20}, 0.9)}) {
    for (const auto& spacing : {std::array{1.0, 1.0, 1.0}, std::array{0.3, 0.3, 1.5},
                                std::array{2.5, 1.0, 1.1}, std::array{1.0, 40.0, 1.0}}) {
      const Volume object = Placed(points, spacing);
      const auto euclidean = ComputeDistance(object, DistanceKind::kEuclidean, {});
      const std::vector<float> expected = *ExactRadii(object, ExactRadius(object, *euclidean), {});
      for (DistanceKind kind : {DistanceKind::kChamfer, DistanceKind::kChamferOptimal}) {
        const auto chamfer = ComputeDistance(object, kind, {});
        test::TeamContext context(3);
        ASSERT_EQ(*ExactRadii(object, ExactRadius(object, *chamfer), context), expected);
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, ExactRadiusLaw, testing::Range<uint64_t>(0, 3, test::kStride));

TEST(ExactRadii, AreTheSameForEveryInstructionSetAndWithoutTheFieldsValues) {
  const Volume object = Placed(test::RandomBlob(5, {40, 30, 30}, 3, 20), {0.3, 0.7, 1.5});
  const auto euclidean = ComputeDistance(object, DistanceKind::kEuclidean, {});
  const std::vector<float> expected = *ExactRadii(object, ExactRadius(object, *euclidean), {});
  const DistanceField none(DistanceKind::kChamfer, ChamferWeights(), DistanceField::Values(), 0);
  for (const std::string& name : exec::SupportedInstructionSets()) {
    ASSERT_TRUE(exec::ChooseInstructionSet(name));
    EXPECT_EQ(*ExactRadii(object, ExactRadius(object, none), {}), expected) << name;
  }
  exec::ChooseInstructionSet("");
}

// Two blocks of full bricks far from each other: all background lies in bricks that are not stored.
TEST(ExactRadii, AreFoundWhereBricksAreMissing) {
  VolumeBuilder builder({400, 60, 60});
  for (int32_t at : {2, 20}) {
    for (Sublattice sublattice : kSublattices) {
      for (int32_t n = 0; n < 8; ++n) {
        const BrickCoordinates brick = {at + (n & 1), at / 4 + (n >> 1 & 1), 2 + (n >> 2),
                                        sublattice};
        builder.Brick(BrickKey(brick)).words.fill(~uint64_t{0});
      }
    }
  }
  const Volume object = *std::move(builder).Build();
  const auto euclidean = ComputeDistance(object, DistanceKind::kEuclidean, {});
  const DistanceField none(DistanceKind::kChamfer, ChamferWeights(), DistanceField::Values(), 0);
  EXPECT_EQ(*ExactRadii(object, ExactRadius(object, none), {}),
            *ExactRadii(object, ExactRadius(object, *euclidean), {}));
}

TEST(ExactRadius, OfABackgroundPointIsZero) {
  const Volume object = VolumeOfPoints(test::RandomBlob(1, {20, 20, 20}, 3, 9));
  const auto field = ComputeDistance(object, DistanceKind::kChamfer, {});
  ExactRadius radius(object, *field);
  EXPECT_EQ(radius.At({-2, 0, 0}), 0);
  EXPECT_EQ(radius.At({1, 2, 2}), 0) << "not on the lattice";
  EXPECT_EQ(radius.At({38, 38, 38}), 0);
}

// Straight from the definition, for objects with the same spacing along all axes.
LatticePoint FirstNearestTo(LatticePoint p, const Volume& object, float radius) {
  const auto squared = static_cast<int32_t>(std::lround(radius * radius));
  const auto most = static_cast<int32_t>(radius);
  for (int32_t z = -most; z <= most; ++z) {
    for (int32_t y = -most; y <= most; ++y) {
      for (int32_t x = -most; x <= most; ++x) {
        const LatticePoint q = p + LatticePoint{x, y, z};
        if (x * x + y * y + z * z == squared && IsOnLattice(q) && !object.Contains(q)) return q;
      }
    }
  }
  return p;
}

// Many points of a cloud have several background points equally near.
TEST(ExactRadius, FindsTheFirstOfEquallyNearPoints) {
  const Volume object = Placed(test::RandomCloud(7, {40, 20, 20}, 0.9), {1, 1, 1});
  const ExactRadius untouched(object);
  ExactRadius searching = untouched;
  size_t otherwise = 0;
  object.ForEachPoint([&](LatticePoint p) {
    const float radius = searching.At(p);
    const LatticePoint first = FirstNearestTo(p, object, radius);
    if (searching.nearest() != first) ++otherwise;
    for (const float share : {1.0F, 0.5F}) {
      ASSERT_EQ(searching.FirstNearestAt(p, share * radius), first) << share;
    }
  });
  EXPECT_GT(otherwise, 0U);
}

// A long box has points with radii above the limits of the searches, and ties on two of its faces,
// inside of stored bricks or beyond them.
TEST(ExactRadius, FindsTheFirstOfEquallyNearPointsOfThickObjects) {
  for (const int32_t first : {4, 0}) {
    VolumeBuilder builder({60, 60, 80});
    for (LatticePoint p : test::RandomCloud(7, {34, 44, 60}, 1)) {
      builder.Add(p + LatticePoint{first, first, first});
    }
    builder.Remove({40, 40, 60});
    const Volume object = *std::move(builder).Build();
    ExactRadius searching(object);
    float thickest = 0;
    size_t n = 0;
    object.ForEachPoint([&](LatticePoint p) {
      if (n++ % 101 != 0) return;
      const float radius = searching.At(p);
      thickest = std::max(thickest, radius);
      ASSERT_EQ(searching.FirstNearestAt(p, radius), FirstNearestTo(p, object, radius)) << first;
    });
    EXPECT_GT(thickest, 30);
  }
}

TEST(ExactRadii, StopWhenAsked) {
  const Volume object = VolumeOfPoints(test::RandomBlob(1, {20, 20, 20}, 3, 9));
  const auto field = ComputeDistance(object, DistanceKind::kChamfer, {});
  const exec::Context context = test::Stopped();
  EXPECT_EQ(ExactRadii(object, ExactRadius(object, *field), context).status().code(),
            absl::StatusCode::kCancelled);
}

// Some 10^5 places, of which a search looks at few groups: those in near groups of groups.
TEST(BorderBricks, HaveLevelsOfGroupsUpToAFew) {
  const Volume object = VolumeOfPoints(test::RandomCloud(1, {260, 260, 260}, 0.003));
  const BorderBricks border(object);
  ASSERT_GT(border.places().size(), 10 * kBoxGroup * kBoxGroup);
  EXPECT_EQ(border.groups().back().size(), kBoxGroup);
  const SquaredWays<1> y(1);
  const SquaredWays<kBrickY> z(1);
  std::vector<NearBox> in_levels(border.groups().front().size()), all = in_levels;
  for (int32_t n = 0; n < 20; ++n) {
    const PointSearch search = {.at = {25 * n, 510 - 25 * n, 20 * n}, .y = y, .z = z};
    const float below = 40.0f * static_cast<float>(n * n);
    const size_t found = FindNearBoxes(border.groups(), search, below, in_levels.data());
    ASSERT_EQ(found, FindNearBoxes(border.groups().first(1), search, below, all.data()));
    for (size_t box = 0; box < found; ++box) {
      ASSERT_EQ(in_levels[box].box, all[box].box);
      ASSERT_EQ(in_levels[box].squared, all[box].squared);
    }
  }
}

}  // namespace
}  // namespace bccskel::exact_radius
