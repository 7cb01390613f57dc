// The exact conversion, held to its definition and to the topology of the mask.
#include <gtest/gtest.h>

#include <array>
#include <ostream>
#include <vector>

#include "core/certificate/certificate.h"
#include "core/mask/mask_converter.h"
#include "core/pipeline/skeletonize.h"
#include "tests/core/mask/mask_words.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_mask.h"

namespace bccskel {

void PrintTo(const BettiNumbers& b, std::ostream* out) {
  *out << "(" << b.components << ", " << b.loops << ", " << b.cavities << ")";
}

namespace {

using test::Converted;
using test::kBothAdjacencies;
using test::MaskOfBits;
using test::ReachOf;
using test::ReferenceMask;

// What every conversion must satisfy. Returns the object.
Volume ExpectTopologyKept(const ReferenceMask& mask, MaskAdjacency adjacency) {
  const ConvertedMask converted = Converted(mask, {.adjacency = adjacency});
  EXPECT_EQ(converted.mask, test::ReferenceMaskBetti(mask, ReachOf(adjacency)));
  const auto object = CountBettiNumbers(converted.volume, {});
  EXPECT_TRUE(object.ok()) << object.status();
  EXPECT_EQ(*object, converted.mask) << DescribeChanges(converted.mask, *object);
  return converted.volume;
}

void ExpectTopologyKeptToTheSkeleton(const ReferenceMask& mask, MaskAdjacency adjacency) {
  const Volume object = ExpectTopologyKept(mask, adjacency);
  const auto skeleton = Skeletonize(object, {}, {});
  ASSERT_TRUE(skeleton.ok()) << skeleton.status();
  EXPECT_EQ(skeleton->certificate.skeleton, test::ReferenceMaskBetti(mask, ReachOf(adjacency)));
}

TEST(ExactConversion, KeepsTheTopologyOfAllMasksOfTwoByTwoByTwoVoxelsToTheSkeleton) {
  for (uint64_t bits = 0; bits < 1 << 8; ++bits) {
    SCOPED_TRACE(bits);
    for (MaskAdjacency adjacency : kBothAdjacencies) {
      const ReferenceMask mask = MaskOfBits(2, 2, 2, bits);
      ExpectTopologyKeptToTheSkeleton(mask, adjacency);
      const test::ReferencePointSet points(test::ReferenceExactPoints(mask, ReachOf(adjacency)));
      if (bits == 0) continue;
      EXPECT_EQ(test::ReferenceBetti(points), test::ReferenceMaskBetti(mask, ReachOf(adjacency)));
    }
  }
}

TEST(ExactConversion, KeepsTheTopologyOfAllMasksOfThreeByTwoByTwoVoxelsToTheSkeleton) {
  for (uint64_t bits = 0; bits < 1 << 12; ++bits) {
    SCOPED_TRACE(bits);
    for (MaskAdjacency adjacency : kBothAdjacencies) {
      ExpectTopologyKeptToTheSkeleton(MaskOfBits(3, 2, 2, bits), adjacency);
    }
  }
}

// Every mask of 3 x 3 x 2 voxels was tried once; here every 31st, so that the test stays fast.
TEST(ExactConversion, KeepsTheTopologyOfMasksOfThreeByThreeByTwoVoxels) {
  for (uint64_t bits = 0; bits < 1 << 18; bits += 31) {
    SCOPED_TRACE(bits);
    for (MaskAdjacency adjacency : kBothAdjacencies) {
      ExpectTopologyKept(MaskOfBits(3, 3, 2, bits), adjacency);
    }
  }
}

TEST(ExactConversion, KeepsTheTopologyOfRandomMasksOfFourCubedVoxels) {
  for (uint64_t seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE(seed);
    const double density = 0.1 + 0.1 * static_cast<double>(seed % 9);
    for (MaskAdjacency adjacency : kBothAdjacencies) {
      ExpectTopologyKept(test::RandomMask(seed, 4, 4, 4, density), adjacency);
    }
  }
}

// On either side of the borders of words (64 voxels) and bricks (8 x 2 x 4 voxels).
constexpr std::array<int32_t, 3> kSizes[] = {
    {63, 3, 5}, {64, 4, 4},  {65, 5, 3},  {7, 6, 9},   {8, 7, 8},
    {9, 2, 7},  {128, 2, 4}, {129, 3, 5}, {1, 1, 130}, {1, 70, 1},
};

TEST(ExactConversion, GivesTheObjectOfItsDefinitionAtEverySize) {
  for (const auto& [nx, ny, nz] : kSizes) {
    for (double density : {0.03, 0.3, 0.9, 1.0}) {
      SCOPED_TRACE(testing::Message() << nx << " x " << ny << " x " << nz << ", " << density);
      const ReferenceMask mask = test::RandomMask(7, nx, ny, nz, density);
      for (MaskAdjacency adjacency : kBothAdjacencies) {
        const ConvertedMask converted = Converted(mask, {.adjacency = adjacency});
        auto points = test::ReferenceExactPoints(mask, ReachOf(adjacency));
        std::ranges::sort(points);
        EXPECT_EQ(converted.volume.SortedPoints(), points);
        EXPECT_EQ(converted.mask, test::ReferenceMaskBetti(mask, ReachOf(adjacency)));
        EXPECT_EQ(converted.volume.extent(), (LatticeExtent{2 * nx + 1, 2 * ny + 1, 2 * nz + 1}));
      }
    }
  }
}

TEST(ExactConversion, KeepsTheTopologyOfLargerRandomMasksToTheSkeleton) {
  for (uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    for (MaskAdjacency adjacency : kBothAdjacencies) {
      ExpectTopologyKeptToTheSkeleton(test::RandomBallMask(seed, 70, 33, 29, 60, 6), adjacency);
      ExpectTopologyKeptToTheSkeleton(test::RandomMask(seed, 67, 21, 18, 0.5), adjacency);
    }
  }
}

TEST(ExactConversion, WritesVolumesThatSatisfyTheInvariants) {
  const ReferenceMask mask = test::RandomMask(3, 72, 9, 9, 0.2);
  const Volume volume = Converted(mask, {}).volume;
  const auto checked = Volume::Create(volume.extent(), volume.placement(),
                                      {volume.keys().begin(), volume.keys().end()},
                                      {volume.bricks().begin(), volume.bricks().end()});
  ASSERT_TRUE(checked.ok()) << checked.status();
  EXPECT_EQ(*checked, volume);
}

// Voxels as odd points and their corners as even points, not refined: the corners of two voxels
// that lie one apart are neighbors.
TEST(ExactConversion, NeedsTheRefinement) {
  const ReferenceMask mask = MaskOfBits(3, 1, 1, 0b101);
  std::vector<LatticePoint> points;
  for (int32_t x : {0, 2}) {
    points.push_back({2 * x + 1, 1, 1});
    for (int32_t corner = 0; corner < 8; ++corner) {
      points.push_back({2 * (x + (corner & 1)), corner & 2, (corner & 4) / 2});
    }
  }
  const auto unrefined = CountBettiNumbers(VolumeOfPoints(points), {});
  ASSERT_TRUE(unrefined.ok());
  EXPECT_EQ(unrefined->components, 1);
  EXPECT_EQ(test::ReferenceMaskBetti(mask, test::ObjectReach::kCorner26).components, 2);
  ExpectTopologyKept(mask, MaskAdjacency::k26);
}

TEST(ExactConversion, KeepsWorldCoordinates) {
  const Placement image = {{0.5, 2, 3}, {10, -20, 30}, {0, -1, 0, 1, 0, 0, 0, 0, -1}};
  const ReferenceMask mask = MaskOfBits(5, 4, 3, uint64_t{1} << (2 + 5 * (1 + 4 * 2)));
  const Volume volume = Converted(mask, {}, image).volume;
  // The center of voxel (2, 1, 2) is the corner in the middle of its refined voxels.
  const LatticePoint center = {4 * 2 + 2, 4 * 1 + 2, 4 * 2 + 2};
  EXPECT_TRUE(volume.Contains(center));
  EXPECT_EQ(volume.placement().ToWorld(center), image.ToWorld(2 * 2, 2 * 1, 2 * 2));
  EXPECT_EQ(volume.placement().spacing, (std::array<double, 3>{0.25, 1, 1.5}));
}

TEST(ExactConversion, OfAnEmptyMaskIsEmpty) {
  const ConvertedMask converted = Converted(MaskOfBits(5, 4, 3, 0), {});
  EXPECT_TRUE(converted.volume.empty());
  EXPECT_EQ(converted.mask, BettiNumbers{});
  EXPECT_EQ(converted.voxels, 0u);
}

}  // namespace
}  // namespace bccskel
