// The exact conversion, held to its definition and to the topology of the mask.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <ostream>
#include <vector>

#include "core/certificate/certificate.h"
#include "core/mask/mask_converter.h"
#include "core/pipeline/skeletonize.h"
#include "tests/core/mask/mask_words.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_mask.h"
#include "tests/support/sanitized.h"

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
Volume ExpectTopologyKept(const ReferenceMask& mask, MaskAdjacency adjacency,
                          VoxelPoints per_voxel = VoxelPoints::kTwo) {
  const ConvertedMask converted = Converted(mask, {.adjacency = adjacency, .points = per_voxel});
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
  for (uint64_t bits = 0; bits < 1 << 8; bits += test::kStride) {
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

struct SmallMasks {
  std::array<int32_t, 3> size;
  uint64_t step;  // every one of so many; each was tried once
};
constexpr SmallMasks kSmallMasks[] = {
    {{2, 2, 3}, 1}, {{3, 2, 2}, 1}, {{3, 3, 2}, 31}, {{2, 3, 3}, 31},
    {{7, 2, 1}, 1}, {{5, 3, 1}, 3}, {{16, 1, 1}, 7},
};

TEST(ExactConversion, KeepsTheTopologyOfSmallMasks) {
  for (const auto& [size, step] : kSmallMasks) {
    const auto [nx, ny, nz] = size;
    for (uint64_t bits = 0; bits < uint64_t{1} << (nx * ny * nz); bits += step * test::kStride) {
      SCOPED_TRACE(testing::Message() << nx << " x " << ny << " x " << nz << ", " << bits);
      for (MaskAdjacency adjacency : kBothAdjacencies) {
        ExpectTopologyKept(MaskOfBits(nx, ny, nz, bits), adjacency);
      }
    }
  }
}

// From dust to nearly full.
TEST(ExactConversion, KeepsTheTopologyOfRandomMasks) {
  constexpr std::array<int32_t, 3> kRandomSizes[] = {{4, 4, 4}, {3, 3, 3}, {5, 5, 1}, {9, 6, 5}};
  for (uint64_t seed = 0; seed < 1600; seed += test::kStride) {
    SCOPED_TRACE(seed);
    const double density = 0.02 + 0.06 * static_cast<double>(seed % 16);
    const auto& [nx, ny, nz] = kRandomSizes[seed / 16 % 4];
    for (MaskAdjacency adjacency : kBothAdjacencies) {
      ExpectTopologyKept(test::RandomMask(seed, nx, ny, nz, density), adjacency);
    }
  }
}

TEST(ExactConversion, KeepsTheTopologyWithSixteenPointsAVoxel) {
  for (uint64_t bits = 0; bits < 1 << 12; bits += test::kStride) {
    SCOPED_TRACE(bits);
    for (MaskAdjacency adjacency : kBothAdjacencies) {
      const ReferenceMask mask = MaskOfBits(3, 2, 2, bits);
      ExpectTopologyKept(mask, adjacency, VoxelPoints::kSixteen);
    }
  }
}

// On either side of the borders of words (64 voxels) and bricks (16 x 4 x 8 voxels).
constexpr std::array<int32_t, 3> kSizes[] = {
    {63, 3, 5}, {64, 4, 4},  {65, 5, 3},  {7, 6, 9},   {15, 7, 8}, {16, 8, 15}, {17, 9, 16},
    {9, 2, 7},  {128, 2, 4}, {129, 3, 5}, {1, 1, 130}, {1, 70, 1}, {33, 4, 17}, {70, 13, 25},
};

void ExpectPoints(const ConvertedMask& converted, std::vector<LatticePoint> points) {
  std::ranges::sort(points);
  EXPECT_EQ(converted.volume.SortedPoints(), points);
}

TEST(ExactConversion, GivesTheObjectOfItsDefinitionAtEverySize) {
  for (const auto& [nx, ny, nz] : kSizes) {
    for (double density : {0.03, 0.3, 0.9, 1.0}) {
      SCOPED_TRACE(testing::Message() << nx << " x " << ny << " x " << nz << ", " << density);
      const ReferenceMask mask = test::RandomMask(7, nx, ny, nz, density);
      for (MaskAdjacency adjacency : kBothAdjacencies) {
        const ConvertedMask converted = Converted(mask, {.adjacency = adjacency});
        ExpectPoints(converted, test::ReferenceExactPoints(mask, ReachOf(adjacency)));
        EXPECT_EQ(converted.mask, test::ReferenceMaskBetti(mask, ReachOf(adjacency)));
        EXPECT_EQ(converted.volume.extent(), (LatticeExtent{nx + 1, ny + 1, nz + 1}));
      }
    }
  }
}

TEST(ExactConversion, WithSixteenPointsAVoxelIsThatOfTheRefinedMask) {
  for (const auto& [nx, ny, nz] : kSizes) {
    SCOPED_TRACE(testing::Message() << nx << " x " << ny << " x " << nz);
    const ReferenceMask mask = test::RandomMask(7, nx, ny, nz, 0.2);
    for (MaskAdjacency adjacency : kBothAdjacencies) {
      const MaskOptions options = {.adjacency = adjacency, .points = VoxelPoints::kSixteen};
      const ConvertedMask converted = Converted(mask, options);
      ExpectPoints(converted, test::ReferenceExactPoints(Refined(mask), ReachOf(adjacency)));
      EXPECT_EQ(converted.mask, test::ReferenceMaskBetti(mask, ReachOf(adjacency)));
      EXPECT_EQ(converted.volume.extent(), (LatticeExtent{2 * nx + 1, 2 * ny + 1, 2 * nz + 1}));
    }
  }
}

// Solid slabs are what two points a voxel are counted on.
TEST(ExactConversion, MakesAboutTwoPointsOfAVoxel) {
  const ReferenceMask mask = test::RandomMask(1, 50, 50, 50, 1);
  EXPECT_EQ(Converted(mask, {}).volume.PointCount(), 50u * 50 * 50 + 51u * 51 * 51);
}

TEST(ExactConversion, OfSlicesThatAreLeftOutIsThatOfEmptyOnes) {
  const MaskGrid grid = {.nx = 5, .ny = 9, .nz = 60};
  for (int32_t gap = 1; gap < 40; ++gap) {
    ReferenceMask mask = test::RandomMask(1, grid.nx, grid.ny, grid.nz, 0);
    auto converter = *MaskConverter::Create(grid, {});
    for (int32_t z : {3, 3 + gap}) {
      SliceRows rows;
      rows.AddRun(4, 1, 3);
      mask.voxels[mask.Index(1, 4, z)] = mask.voxels[mask.Index(2, 4, z)] = 1;
      ASSERT_TRUE(converter.AddRows(z, rows, {}).ok());
    }
    const auto converted = std::move(converter).FinishRows();
    ASSERT_TRUE(converted.ok());
    EXPECT_EQ(converted->volume, Converted(mask, {}).volume) << gap;
  }
}

TEST(ExactConversion, KeepsTheTopologyOfLargerRandomMasksToTheSkeleton) {
  for (uint64_t seed = 0; seed < 4; seed += test::kStride) {
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

// All corners of two voxels that lie one apart: some are neighbors across the gap.
TEST(ExactConversion, CannotKeepEveryCorner) {
  const ReferenceMask mask = MaskOfBits(3, 1, 1, 0b101);
  std::vector<LatticePoint> points;
  for (int32_t x : {0, 2}) {
    points.push_back({2 * x + 1, 1, 1});
    for (int32_t corner = 0; corner < 8; ++corner) {
      points.push_back({2 * (x + (corner & 1)), corner & 2, (corner & 4) / 2});
    }
  }
  const auto all = CountBettiNumbers(VolumeOfPoints(points), {});
  ASSERT_TRUE(all.ok());
  EXPECT_EQ(all->components, 1);
  EXPECT_EQ(test::ReferenceMaskBetti(mask, test::ObjectReach::kCorner26).components, 2);
  ExpectTopologyKept(mask, MaskAdjacency::k26);
}

TEST(ExactConversion, KeepsWorldCoordinates) {
  const Placement image = {{1, 2, 3}, {10, -20, 30}, {0, -1, 0, 1, 0, 0, 0, 0, -1}};
  const ReferenceMask mask = MaskOfBits(5, 4, 3, uint64_t{1} << (2 + 5 * (1 + 4 * 2)));
  const Volume volume = Converted(mask, {}, image).volume;
  const LatticePoint center = {2 * 2 + 1, 2 * 1 + 1, 2 * 2 + 1};
  EXPECT_TRUE(volume.Contains(center));
  EXPECT_EQ(volume.placement().ToWorld(center), image.ToWorld(2 * 2, 2 * 1, 2 * 2));
  EXPECT_EQ(volume.placement().spacing, image.spacing);
  const Volume fine = Converted(mask, {.points = VoxelPoints::kSixteen}, image).volume;
  // The corner in the middle of the refined voxels.
  const LatticePoint middle = {4 * 2 + 2, 4 * 1 + 2, 4 * 2 + 2};
  EXPECT_TRUE(fine.Contains(middle));
  EXPECT_EQ(fine.placement().ToWorld(middle), image.ToWorld(2 * 2, 2 * 1, 2 * 2));
  EXPECT_EQ(fine.placement().spacing, (std::array<double, 3>{0.5, 1, 1.5}));
}

// The same mask of voxels that are cut into parts.
ReferenceMask InParts(const ReferenceMask& mask, const VoxelParts& parts) {
  const auto [px, py, pz] = parts;
  const auto is_in = [&mask, px = px, py = py, pz = pz](int32_t x, int32_t y, int32_t z) {
    return mask.Contains(x / px, y / py, z / pz);
  };
  return test::MaskWhere(px * mask.nx, py * mask.ny, pz * mask.nz, is_in);
}

TEST(ExactConversion, OfLongVoxelsIsThatOfTheirSlabs) {
  const struct {
    std::array<double, 3> spacing;
    VoxelParts slabs;
  } cases[] = {{{1, 1, 3}, {1, 1, 1}},       {{1, 1, 3.1}, {1, 1, 2}}, {{0.5, 4, 0.7}, {1, 3, 1}},
               {{40, 4.0001, 4}, {4, 1, 1}}, {{8, 1, 9}, {3, 1, 3}},   {{1, 1, 1000}, {1, 1, 8}}};
  for (const auto& [spacing, slabs] : cases) {
    for (const VoxelPoints points : {VoxelPoints::kTwo, VoxelPoints::kSixteen}) {
      for (const MaskAdjacency adjacency : kBothAdjacencies) {
        const ReferenceMask mask = test::RandomMask(3, 5, 6, 7, 0.4);
        const MaskOptions options = {.adjacency = adjacency, .points = points};
        const ConvertedMask converted = Converted(mask, options, {.spacing = spacing});
        const MaskGrid grid = {mask.nx, mask.ny, mask.nz, {.spacing = spacing}};
        EXPECT_EQ(SlabsOf(grid, points), slabs);
        const Volume cut = Converted(InParts(mask, slabs), options).volume;
        EXPECT_EQ(converted.volume.SortedPoints(), cut.SortedPoints());
        EXPECT_EQ(converted.mask, test::ReferenceMaskBetti(mask, ReachOf(adjacency)));
        EXPECT_EQ(*CountBettiNumbers(converted.volume, {}), converted.mask);
        const Placement& placement = converted.volume.placement();
        const int32_t cells = points == VoxelPoints::kTwo ? 1 : 2;
        for (size_t axis = 0; axis < 3; ++axis) {
          EXPECT_DOUBLE_EQ(placement.spacing[axis], spacing[axis] / slabs[axis] / cells);
          EXPECT_DOUBLE_EQ(placement.origin[axis], -spacing[axis] / 2);
        }
      }
    }
  }
}

TEST(ExactConversion, CutsNoMoreSlabsThanTheExtentHasCellsFor) {
  const MaskGrid long_grid = {1, 1, kMaxMaskVoxels / 2, {.spacing = {1, 1, 100}}};
  EXPECT_EQ(SlabsOf(long_grid, VoxelPoints::kTwo), (VoxelParts{1, 1, 4}));
  EXPECT_EQ(SlabsOf(long_grid, VoxelPoints::kSixteen), (VoxelParts{1, 1, 2}));
  EXPECT_TRUE(CheckGrid(ExactExtent(long_grid, VoxelPoints::kTwo), long_grid.placement).ok());
  EXPECT_TRUE(CheckGrid(ExactExtent(long_grid, VoxelPoints::kSixteen), long_grid.placement).ok());
}

TEST(ExactConversion, OfAnEmptyMaskIsEmpty) {
  const ConvertedMask converted = Converted(MaskOfBits(5, 4, 3, 0), {});
  EXPECT_TRUE(converted.volume.empty());
  EXPECT_EQ(converted.mask, BettiNumbers{});
  EXPECT_EQ(converted.voxels, 0u);
}

}  // namespace
}  // namespace bccskel
