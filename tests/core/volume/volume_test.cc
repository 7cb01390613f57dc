#include "core/volume/volume.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

using ::testing::HasSubstr;

constexpr LatticeExtent kSomeBricks = {40, 11, 21};

absl::Status CreateStatus(LatticeExtent extent, const Placement& placement,
                          std::vector<BrickKey> keys = {}, std::vector<BrickBits> bricks = {}) {
  return Volume::Create(extent, placement, std::move(keys), std::move(bricks)).status();
}

BrickBits OneBit(int bit) {
  BrickBits bits;
  bits.Set(bit);
  return bits;
}

TEST(VolumeLaw, ContainsExactlyThePointsThatWereAdded) {
  for (double density : {0.01, 0.5, 1.0}) {
    const auto points = test::RandomCloud(3, kSomeBricks, density);
    VolumeBuilder builder(kSomeBricks);
    for (LatticePoint p : points) builder.Add(p);
    const Volume volume = *std::move(builder).Build();
    EXPECT_EQ(volume.PointCount(), points.size());
    EXPECT_EQ(volume.SortedPoints(), points);
    const std::set<LatticePoint> expected(points.begin(), points.end());
    for (int32_t z = -2; z < 2 * kSomeBricks.nz + 3; ++z) {
      for (int32_t y = -2; y < 2 * kSomeBricks.ny + 3; ++y) {
        for (int32_t x = -2; x < 2 * kSomeBricks.nx + 3; ++x) {
          ASSERT_EQ(volume.Contains({x, y, z}), expected.contains({x, y, z}));
        }
      }
    }
  }
}

TEST(VolumeLaw, EqualPointSetsMakeEqualVolumesInAnyOrder) {
  auto points = test::RandomCloud(5, kSomeBricks, 0.02);
  const auto build = [&] {
    VolumeBuilder builder(kSomeBricks);
    for (LatticePoint p : points) builder.Add(p);
    return *std::move(builder).Build();
  };
  const Volume first = build();
  std::ranges::shuffle(points, std::mt19937(1));
  EXPECT_EQ(build(), first);
  points.pop_back();
  EXPECT_NE(build(), first);
}

TEST(Volume, KeepsItsBricksInOrderAndStoresNoEmptyOne) {
  VolumeBuilder builder(kSomeBricks);
  for (LatticePoint p : test::RandomCloud(7, kSomeBricks, 0.003)) builder.Add(p);
  builder.Brick(BrickKey({0, 0, 0, Sublattice::kOdd}));
  const Volume volume = *std::move(builder).Build();
  EXPECT_TRUE(std::ranges::is_sorted(volume.keys()));
  EXPECT_EQ(std::ranges::adjacent_find(volume.keys()), volume.keys().end());
  for (const BrickBits& brick : volume.bricks()) EXPECT_FALSE(brick.Empty());
  ASSERT_EQ(volume.padded_bricks().size(), volume.brick_count() + 1);
  EXPECT_TRUE(volume.padded_bricks().back().Empty());
}

TEST(Volume, VisitsEveryPointOnce) {
  const auto points = test::RandomBlob(2, kSomeBricks, 5, 9);
  std::multiset<LatticePoint> visited;
  VolumeOfPoints(points).ForEachPoint([&](LatticePoint p) { visited.insert(p); });
  EXPECT_EQ(visited, std::multiset<LatticePoint>(points.begin(), points.end()));
}

TEST(VolumeBuilder, IgnoresWhatIsNoPointOfItsLattice) {
  VolumeBuilder builder({2, 2, 2});
  for (LatticePoint p : {LatticePoint{1, 0, 0}, {-2, 0, 0}, {4, 0, 0}, {-1, -1, -1}, {3, 5, 3}}) {
    builder.Add(p);
    builder.Remove(p);
  }
  EXPECT_TRUE((*std::move(builder).Build()).empty());
}

TEST(VolumeBuilder, RemovesWhatWasAdded) {
  VolumeBuilder builder({2, 2, 2});
  builder.Add({1, 1, 1});
  builder.Add({2, 2, 2});
  builder.Remove({1, 1, 1});
  builder.Remove({0, 0, 0});
  EXPECT_EQ((*std::move(builder).Build()).SortedPoints(), (std::vector<LatticePoint>{{2, 2, 2}}));
}

TEST(Volume, OfPointsIsJustLargeEnough) {
  const std::vector<LatticePoint> points = {{5, 7, 9}, {0, 20, 2}};
  const Volume volume = VolumeOfPoints(points);
  EXPECT_EQ(volume.extent(), (LatticeExtent{3, 11, 5}));
  EXPECT_EQ(volume.PointCount(), 2u);
  EXPECT_TRUE(VolumeOfPoints({}).empty());
}

TEST(Volume, TakesTheLargestExtentAndPaysForItsPointsOnly) {
  constexpr LatticeExtent kLargest = {kMaxExtentCells, kMaxExtentCells, kMaxExtentCells};
  constexpr int32_t kEnd = 2 * kMaxExtentCells - 1;
  VolumeBuilder builder(kLargest);
  for (LatticePoint p : {LatticePoint{0, 0, 0}, {kEnd, kEnd, kEnd}, {kEnd, 1, kEnd}}) {
    builder.Add(p);
  }
  const auto volume = std::move(builder).Build();
  ASSERT_TRUE(volume.ok()) << volume.status();
  EXPECT_EQ(volume->brick_count(), 3u);
  EXPECT_TRUE(volume->Contains({kEnd, kEnd, kEnd}));
  EXPECT_TRUE(volume->Contains({kEnd, 1, kEnd}));
  EXPECT_FALSE(volume->Contains({kEnd + 1, kEnd + 1, kEnd + 1}));
}

TEST(Volume, RefusesExtentsThatAreEmptyOrTooLarge) {
  constexpr int32_t kMax = kMaxExtentCells;
  for (LatticeExtent bad : {LatticeExtent{0, 1, 1}, {1, -1, 1}, {1, 1, kMax + 1}}) {
    const absl::Status status = CreateStatus(bad, {});
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(status.message(), HasSubstr("4194304"));
  }
  EXPECT_TRUE(CreateStatus({kMax, 1, kMax}, {}).ok());
}

TEST(Volume, RefusesPlacementsThatAreNoFrame) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  std::vector<Placement> bad;
  for (double spacing : {0.0, -1.0, nan, inf}) bad.push_back({.spacing = {1, spacing, 1}});
  for (double origin : {nan, inf}) bad.push_back({.origin = {0, 0, origin}});
  bad.push_back({.direction = {1, 0, 0, 0, nan, 0, 0, 0, 1}});
  for (const Placement& placement : bad) {
    const absl::Status status = CreateStatus({1, 1, 1}, placement);
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(status.message(), HasSubstr("finite"));
  }
}

TEST(Volume, RefusesDirectionsThatScaleOrShear) {
  const auto message = [](const std::array<double, 9>& direction) {
    const absl::Status status = CreateStatus({1, 1, 1}, {.direction = direction});
    return status.ok() ? std::string() : std::string(status.message());
  };
  EXPECT_THAT(message({2, 0, 0, 0, 1, 0, 0, 0, 1}), HasSubstr("axis 0 has the length 2"));
  EXPECT_THAT(message({1, 0, 0, 0, 1, 0, 0, 0, 0}), HasSubstr("axis 2 has the length 0"));
  EXPECT_THAT(message({1, 0.6, 0, 0, 0.8, 0, 0, 0, 1}), HasSubstr("axes 0 and 1"));
  EXPECT_EQ(message({1.0004, 0, 0, 0.0004, 1, 0, 0, 0, 1}), "");  // rounded
  EXPECT_EQ(message({0, -1, 0, 1, 0, 0, 0, 0, -1}), "");          // a mirror
}

TEST(Volume, SortsBricksGivenInAnyOrder) {
  const BrickKey low({0, 0, 0, Sublattice::kEven}), high({1, 0, 0, Sublattice::kOdd});
  const auto volume = Volume::Create({32, 4, 8}, {}, {high, low}, {OneBit(1), OneBit(2)});
  ASSERT_TRUE(volume.ok()) << volume.status();
  EXPECT_EQ(volume->SortedPoints(), (std::vector<LatticePoint>{{4, 0, 0}, {35, 1, 1}}));
}

TEST(Volume, RefusesABrickGivenTwice) {
  const BrickKey key({0, 0, 0, Sublattice::kEven});
  const absl::Status status = CreateStatus({16, 4, 8}, {}, {key, key}, {OneBit(0), OneBit(1)});
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), HasSubstr("twice"));
}

TEST(Volume, RefusesMoreKeysThanBricks) {
  EXPECT_EQ(CreateStatus({16, 4, 8}, {}, {BrickKey({0, 0, 0, Sublattice::kEven})}).code(),
            absl::StatusCode::kInvalidArgument);
}

TEST(Volume, RefusesBricksOutsideTheExtent) {
  for (BrickCoordinates brick : {BrickCoordinates{-1, 0, 0, Sublattice::kOdd},
                                 {1, 0, 0, Sublattice::kEven},
                                 {0, 1, 0, Sublattice::kEven},
                                 {0, 0, 1, Sublattice::kOdd}}) {
    const absl::Status status = CreateStatus({16, 4, 8}, {}, {BrickKey(brick)}, {OneBit(0)});
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(status.message(), HasSubstr("16 x 4 x 8"));
  }
}

TEST(Volume, RefusesExactlyTheBitsOutsideTheExtent) {
  constexpr LatticeExtent kExtent = {13, 3, 5};
  for (Sublattice s : kSublattices) {
    const BrickCoordinates brick = {0, 0, 0, s};
    for (int bit = 0; bit < kBrickPoints; ++bit) {
      const bool inside = kExtent.Contains(PointOf(brick, bit));
      EXPECT_EQ(CreateStatus(kExtent, {}, {BrickKey(brick)}, {OneBit(bit)}).ok(), inside) << bit;
    }
  }
}

}  // namespace
}  // namespace bccskel
