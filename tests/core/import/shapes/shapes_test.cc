#include "core/import/shapes/shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/certificate/certificate.h"
#include "tests/support/object_parts.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/sanitized.h"

namespace bccskel {
namespace {

ShapeOptions Options(uint64_t points, uint64_t seed = 0, double noise = 0) {
  return {.points = points, .seed = seed, .noise = noise};
}

Volume Generate(Shape shape, const ShapeOptions& options) {
  auto volume = GenerateShape(shape, options);
  EXPECT_TRUE(volume.ok()) << volume.status();
  return *std::move(volume);
}

// As documented at each enumerator.
BettiNumbers DocumentedBetti(Shape shape) {
  switch (shape) {
    case Shape::kTorus:
    case Shape::kKnot:
      return {1, 1, 0};
    case Shape::kHollowBall:
      return {1, 0, 1};
    default:
      return {1, 0, 0};
  }
}

// The numbers of points of the tries for a scale.
std::vector<uint64_t> SumsOf(Shape shape, const ShapeOptions& options) {
  std::vector<uint64_t> sums;
  const auto note = [&](uint64_t points) {
    sums.push_back(points);
    return points;
  };
  EXPECT_TRUE(GenerateShapePart(shape, options, {}, note).ok());
  return sums;
}

class EveryShape : public testing::TestWithParam<Shape> {};

TEST_P(EveryShape, HasTheDocumentedTopologyWhateverTheSizeAndTheSeed) {
  const BettiNumbers expected = DocumentedBetti(GetParam());
  for (uint64_t seed = 0; seed < 4; seed += test::kStride) {
    const Volume small = Generate(GetParam(), Options(kMinShapePoints, seed));
    EXPECT_EQ(test::ReferenceBetti(test::ReferencePointSet(small)), expected) << seed;
    // Flood fills of a tree's box would take seconds here.
    const Volume large = Generate(GetParam(), Options(20'000, seed));
    EXPECT_EQ(*CountBettiNumbers(large, {}), expected) << seed;
  }
}

TEST_P(EveryShape, IsTheSameInParts) {
  for (const double noise : {0.0, 0.05}) {
    const ShapeOptions options = Options(60'000, 3, noise);
    const Volume whole = Generate(GetParam(), options);
    // The parts one after the other need to know what the sums will be: those of the whole.
    const std::vector<uint64_t> sums = SumsOf(GetParam(), options);
    for (const int32_t count : {2, 3, 5}) {
      std::vector<Volume> parts;
      for (int32_t index = 0; index < count; ++index) {
        auto part = GenerateShapePart(GetParam(), options, {index, count},
                                      [&, n = size_t{0}](uint64_t) mutable { return sums[n++]; });
        ASSERT_TRUE(part.ok()) << part.status();
        parts.push_back(*std::move(part));
      }
      EXPECT_EQ(*test::Joined(parts), whole);
    }
  }
}

TEST_P(EveryShape, HasTheWantedNumberOfPointsWithin3Percent) {
  for (double noise : {0.0, 0.05, kMaxShapeNoise}) {
    for (uint64_t points : {kMinShapePoints, uint64_t{33'333}, uint64_t{200'000}}) {
      const Volume volume = Generate(GetParam(), Options(points, 7, noise));
      EXPECT_NEAR(static_cast<double>(volume.PointCount()) / static_cast<double>(points), 1, 0.03);
    }
  }
}

TEST_P(EveryShape, IsTheSameForTheSameArguments) {
  const Volume once = Generate(GetParam(), Options(20'000, 5, 0.05));
  EXPECT_EQ(Generate(GetParam(), Options(20'000, 5, 0.05)), once);
  EXPECT_NE(Generate(GetParam(), Options(20'000, 6, 0.05)), once);
}

TEST_P(EveryShape, FlipsTheWantedFractionOfTheBoundary) {
  const Volume clean = Generate(GetParam(), Options(10'000, 3));
  const test::ReferencePointSet before(clean);
  const Volume noisy = Generate(GetParam(), Options(10'000, 3, 0.1));
  // The noisy shape is scaled anew, so only its roughness can be compared: single points that
  // stick out or are missing have nearly all or nearly no neighbors.
  const auto rough_points = [](const test::ReferencePointSet& object) {
    int count = 0;
    object.ForEachLatticePointOfBox([&](LatticePoint p) {
      const int neighbors = std::popcount(object.NeighborsOf(p));
      count += object.Contains(p) ? neighbors <= 2 : neighbors >= 12;
    });
    return count;
  };
  EXPECT_GT(rough_points(test::ReferencePointSet(noisy)), 20 + 2 * rough_points(before));
}

TEST_P(EveryShape, LeavesFreeCellsAroundItself) {
  const Volume volume = Generate(GetParam(), Options(20'000, 1, 0.1));
  const LatticeExtent& extent = volume.extent();
  volume.ForEachPoint([&](LatticePoint p) {
    ASSERT_TRUE(p.x >= 2 && p.y >= 2 && p.z >= 2);
    ASSERT_TRUE(p.x < 2 * extent.nx - 2 && p.y < 2 * extent.ny - 2 && p.z < 2 * extent.nz - 2);
  });
}

TEST_P(EveryShape, IsFoundByItsName) {
  const auto found = ParseShapeName(ShapeName(GetParam()));
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(*found, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::ValuesIn(kShapes), [](const auto& info) {
  std::string name(ShapeName(info.param));
  std::erase(name, '-');
  return name;
});

TEST(Shapes, TubesFillAboutOnePercentOfTheirBox) {
  for (uint64_t seed = 0; seed < 4; ++seed) {
    const Volume tubes = Generate(Shape::kTubes, Options(100'000, seed));
    const double fill =
        static_cast<double>(tubes.PointCount()) / static_cast<double>(tubes.extent().PointCount());
    EXPECT_GT(fill, 0.009) << seed;
    EXPECT_LT(fill, 0.025) << seed;
  }
}

TEST(Shapes, MemoryFollowsTheObjectNotTheBox) {
  const Volume tubes = Generate(Shape::kTubes, Options(850'000));
  EXPECT_LT(tubes.brick_count() * kBrickPoints, 6u * 850'000);
}

TEST(Shapes, RefusesOptionsOutOfRange) {
  using testing::HasSubstr;
  const auto message = [](const ShapeOptions& options) {
    return std::string(GenerateShape(Shape::kBall, options).status().message());
  };
  EXPECT_THAT(message(Options(kMinShapePoints - 1)), HasSubstr("4999 points: must be 5000 to"));
  EXPECT_THAT(message(Options(kMaxShapePoints + 1)), HasSubstr("must be 5000 to 8589934592"));
  EXPECT_THAT(message(Options(10'000, 0, 0.11)), HasSubstr("noise 0.11: must be 0 to 0.1"));
  EXPECT_THAT(message(Options(10'000, 0, -1)), HasSubstr("noise -1"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message(Options(10'000, 0, nan)), HasSubstr("noise nan"));
}

TEST(Shapes, AnUnknownNameIsAnsweredWithAllNames) {
  const auto status = ParseShapeName("cow").status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(status.message(),
            "no shape is named \"cow\": must be one of ball, torus, tubes, blob, horse, tree, "
            "knot, box, hollow-ball");
}

}  // namespace
}  // namespace bccskel
