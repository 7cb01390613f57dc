#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/distance/distance_field.h"
#include "core/distance/euclidean_stream.h"
#include "core/exec/instruction_sets.h"
#include "core/import/shapes/shapes.h"
#include "core/lattice/directions.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/sanitized.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

Volume Placed(const std::vector<LatticePoint>& points, const std::array<double, 3>& spacing) {
  return test::VolumeWith(points, VolumeOfPoints(points).extent(), {.spacing = spacing});
}

// All background points that have an object neighbor; the nearest one is always among them.
std::vector<LatticePoint> OuterBorder(const Volume& object) {
  std::vector<LatticePoint> border;
  object.ForEachPoint([&](LatticePoint p) {
    for (const LatticePoint offset : kDirections14) {
      if (!object.Contains(p + offset)) border.push_back(p + offset);
    }
  });
  std::ranges::sort(border);
  border.erase(std::unique(border.begin(), border.end()), border.end());
  return border;
}

double SquaredDistance(LatticePoint a, LatticePoint b, const AxisScale& scale) {
  const double x = scale[0] * (a.x - b.x), y = scale[1] * (a.y - b.y), z = scale[2] * (a.z - b.z);
  return x * x + y * y + z * z;
}

void ExpectNearestBackground(const Volume& object, const exec::Context& context) {
  const AxisScale scale = AxisScaleOf(object.placement());
  const std::vector<LatticePoint> border = OuterBorder(object);
  const auto field = ComputeDistance(object, DistanceKind::kEuclidean, context);
  ASSERT_TRUE(field.ok()) << field.status();
  uint32_t largest = 0;
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    for (int bit = 0; bit < kBrickPoints; ++bit) {
      if (!object.bricks()[n].Test(bit)) {
        ASSERT_EQ(field->At(n, bit), 0u);
        continue;
      }
      const LatticePoint p = PointOf(object.keys()[n].coordinates(), bit);
      double nearest = std::numeric_limits<double>::infinity();
      for (LatticePoint q : border) nearest = std::min(nearest, SquaredDistance(p, q, scale));
      const double distance = field->ToLatticeUnits(field->At(n, bit));
      const double squared = distance * distance;
      if (scale == kIsotropic) {
        ASSERT_EQ(std::round(squared), nearest) << p.x << " " << p.y << " " << p.z;
      } else {
        ASSERT_NEAR(squared / nearest, 1, 1e-6) << p.x << " " << p.y << " " << p.z;
      }
      EXPECT_NEAR(distance, std::sqrt(nearest), 1e-4);
      largest = std::max(largest, field->At(n, bit));
    }
  }
  EXPECT_EQ(field->largest(), largest);
}

std::vector<std::vector<LatticePoint>> RandomObjects(uint64_t seed) {
  const LatticeExtent extent = {35, 12, 11};
  std::vector<std::vector<LatticePoint>> objects;
  for (double density : {0.3, 0.9, 0.999}) {
    objects.push_back(test::RandomCloud(seed, extent, density));
  }
  objects.push_back(test::RandomBlob(seed, extent, 4, 10));
  return objects;
}

class EuclideanLaw : public testing::TestWithParam<uint64_t> {};

TEST_P(EuclideanLaw, IsTheDistanceToTheNearestBackgroundPoint) {
  for (const auto& points : RandomObjects(GetParam())) {
    for (const auto& spacing : {std::array{1.0, 1.0, 1.0}, std::array{0.3, 0.3, 1.5},
                                std::array{2.5, 1.0, 1.1}, std::array{1.0, 40.0, 1.0}}) {
      ExpectNearestBackground(Placed(points, spacing), exec::Context());
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, EuclideanLaw, testing::Range<uint64_t>(0, 4, test::kStride));

// Bricks whose neighbors are not stored are the borders of the scans.
TEST(Euclidean, IsExactWhereBricksEnd) {
  for (int32_t shift = 0; shift < 36; shift += 5) {
    const LatticeBox box = {{shift, shift / 2, shift}, {shift + 39, shift / 2 + 11, shift + 19}};
    const auto is_in_box = [&](int32_t x, int32_t y, int32_t z) {
      return box.Contains(LatticePoint{x, y, z});
    };
    ExpectNearestBackground(test::VolumeWhere({90, 60, 60}, is_in_box), exec::Context());
  }
}

// Of full bricks: 256 cells wide and deep, as many high as said.
Volume Slab(int32_t height) {
  return test::FullBricks(256 / kBrickX, height / kBrickY, 256 / kBrickZ);
}

TEST(Euclidean, IsExactWhereSquaresOutgrow16Bits) {
  for (const int32_t height : {252, 256}) {
    if (test::kSanitized && height == 252) continue;  // slow there
    const Volume slab = Slab(height);
    const auto field = ComputeDistance(slab, DistanceKind::kEuclidean, exec::Context());
    ASSERT_TRUE(field.ok()) << field.status();
    const BrickAddress middle = AddressOf({256, height, 256});
    const uint32_t rank = field->At(*slab.Find(BrickKey(middle.brick)), middle.bit);
    EXPECT_EQ(field->ToLatticeUnits(rank), height);
    EXPECT_EQ(field->largest(), rank);
    // In a column that is not deep, measured before the type of all squares was known.
    const BrickAddress side = AddressOf({8, height, 256});
    EXPECT_EQ(field->SquareAt(*slab.Find(BrickKey(side.brick)), side.bit), 83);
  }
}

TEST(Euclidean, IsKeptWhereItTakesTwoBytesAPointOrIsSmall) {
  const auto is_kept = [](const Volume& object) {
    return StreamEuclidean(object, exec::Context(), nullptr, KeepField::kIfSmall)->has_value();
  };
  if (!test::kSanitized) {  // slow there, and only figures
    EXPECT_TRUE(is_kept(Slab(200)));
    EXPECT_FALSE(is_kept(Slab(256)));
  }
  EXPECT_TRUE(is_kept(Placed(test::RandomBlob(7, {40, 30, 30}, 6, 18), {1.0, 1.3, 3.7})));
}

// Whatever is measured together, squares are the same.
TEST(Euclidean, IsTheSameInColumns) {
  for (const auto& spacing : {std::array{1.0, 1.0, 1.0}, std::array{1.0, 0.9, 0.8}}) {
    const Volume object = Placed(test::RandomBlob(5, {90, 40, 40}, 9, 30), spacing);
    const auto expected = ComputeDistance(object, DistanceKind::kEuclidean, exec::Context());
    const auto field = StreamEuclidean(object, exec::Context(), nullptr, KeepField::kAlways, 1);
    ASSERT_TRUE(field.ok()) << field.status();
    EXPECT_EQ((*field)->values(), expected->values());
    EXPECT_EQ((*field)->largest(), expected->largest());
  }
}

// Rows end neither at the border of a part nor at that of what is known, where no background is.
TEST(Euclidean, IsTheSameInColumnsOfAWindow) {
  const Volume whole = Placed(test::RandomBlob(5, {90, 40, 40}, 9, 30), {1, 1, 1});
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bricks;
  for (BrickIndex n = 0; n < whole.brick_count(); ++n) {
    const int32_t bx = whole.keys()[n].coordinates().bx;
    if (bx < 1 || bx > 3) continue;
    keys.push_back(whole.keys()[n]);
    bricks.push_back(whole.bricks()[n]);
  }
  Volume object = Volume::FromSortedBricks(whole.extent(), whole.placement(), keys, bricks);
  object.SetWindow(LatticeBox{{2 * kBrickX, 0, 0}, {8 * kBrickX - 1, 79, 79}});
  const auto expected = ComputeDistance(object, DistanceKind::kEuclidean, exec::Context());
  const auto field = StreamEuclidean(object, exec::Context(), nullptr, KeepField::kAlways, 1);
  ASSERT_TRUE(field.ok()) << field.status();
  EXPECT_EQ((*field)->values(), expected->values());
  const auto of_whole = ComputeDistance(whole, DistanceKind::kEuclidean, exec::Context());
  object.ForEachPoint([&](LatticePoint p) {
    const BrickAddress at = AddressOf(p);
    const BrickKey key(at.brick);
    ASSERT_GE(expected->SquareAt(*object.Find(key), at.bit),
              of_whole->SquareAt(*whole.Find(key), at.bit));
  });
}

// Columns that are too deep to look outward from every point; whole numbers always look outward.
TEST(Euclidean, OfDeepColumnsIsTheSameInFloatsAsInWholeNumbers) {
  const std::vector<LatticePoint> points = test::RandomBlob(3, {70, 70, 70}, 9, 60);
  const Volume even = Placed(points, {1.0, 1.0, 1.0});
  const Volume all_but_even = Placed(points, {1.0, 1.0 + 1e-12, 1.0 - 1e-12});
  ASSERT_NE(AxisScaleOf(all_but_even.placement()), kIsotropic);
  const auto whole = ComputeDistance(even, DistanceKind::kEuclidean, exec::Context());
  const auto floats = ComputeDistance(all_but_even, DistanceKind::kEuclidean, exec::Context());
  ASSERT_GT(whole->ToLatticeUnits(whole->largest()), 40);
  even.ForEachPoint([&](LatticePoint p) {
    const BrickAddress at = AddressOf(p);
    const BrickIndex n = *even.Find(BrickKey(at.brick));
    ASSERT_EQ(floats->ToLatticeUnits(floats->At(n, at.bit)),
              whole->ToLatticeUnits(whole->At(n, at.bit)));
  });
}

void ExpectTheSameEverywhere(const Volume& object);

TEST(Euclidean, IsTheSameForAnyThreadCountAndInstructionSet) {
  ExpectTheSameEverywhere(Placed(test::RandomBlob(7, {40, 30, 30}, 6, 18), {1.0, 1.3, 3.7}));
  ExpectTheSameEverywhere(Placed(test::RandomBlob(7, {40, 30, 30}, 6, 18), {1.0, 1.0, 1.0}));
  ExpectTheSameEverywhere(Placed(test::RandomBlob(5, {70, 70, 70}, 9, 60), {1.0, 0.9, 0.8}));
}

void ExpectTheSameEverywhere(const Volume& object) {
  const auto expected = ComputeDistance(object, DistanceKind::kEuclidean, exec::Context());
  for (const std::string& name : exec::SupportedInstructionSets()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(exec::ChooseInstructionSet(name));
    for (int threads : {1, 3}) {
      test::TeamContext context(threads);
      const auto field = ComputeDistance(object, DistanceKind::kEuclidean, context);
      ASSERT_EQ(field->values(), expected->values());
    }
  }
  exec::ChooseInstructionSet("");
}

TEST(Euclidean, StopsWhenAsked) {
  const Volume object = VolumeOfPoints(test::RandomBlob(1, {20, 20, 20}, 3, 9));
  const exec::Context context = test::Stopped();
  EXPECT_EQ(ComputeDistance(object, DistanceKind::kEuclidean, context).status().code(),
            absl::StatusCode::kCancelled);
}

// A large object has few slabs, each of which takes long.
TEST(Euclidean, AsksAgainAndAgainWhetherToStop) {
  const Volume ball = *GenerateShape(Shape::kBall, {.points = 300'000});
  int asked = 0;
  exec::Context context;
  context.yield = [&asked] { ++asked; };
  ASSERT_TRUE(ComputeDistance(ball, DistanceKind::kEuclidean, context).ok());
  const auto bricks = static_cast<double>(ball.brick_count());
  EXPECT_GT(asked, static_cast<int>(std::pow(bricks, 2.0 / 3)));
}

TEST(Euclidean, OfAnEmptyObjectIsEmpty) {
  const auto field = ComputeDistance(Volume(), DistanceKind::kEuclidean, exec::Context());
  ASSERT_TRUE(field.ok());
  EXPECT_EQ(field->largest(), 0u);
}

}  // namespace
}  // namespace bccskel
