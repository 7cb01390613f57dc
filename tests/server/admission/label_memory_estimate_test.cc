#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <vector>

#include "core/labels/convert_label.h"
#include "core/labels/label_collector.h"
#include "server/admission/memory_estimate.h"

namespace bccskel::server {
namespace {

constexpr std::array<int32_t, 3> kSize = {75, 19, 23};
const MaskGrid kGrid = {.nx = kSize[0], .ny = kSize[1], .nz = kSize[2]};

// Label 1 where `inside`.
template <typename Inside>
LabeledObject ObjectOf(Inside inside) {
  LabelCollector collector = *LabelCollector::Create(kGrid, {});
  for (int32_t z = 0; z < kGrid.nz; ++z) {
    std::vector<uint64_t> slice;
    for (int32_t y = 0; y < kGrid.ny; ++y) {
      for (int32_t x = 0; x < kGrid.nx; ++x) slice.push_back(inside(x, y, z) ? 1 : 0);
    }
    EXPECT_TRUE(collector.AddSlice(slice, exec::Context()).ok());
  }
  LabeledObjects objects = *std::move(collector).Finish();
  EXPECT_EQ(objects.objects.size(), 1u);
  return std::move(objects.objects[0]);
}

// Voxels with other shapes are cut into other parts.
struct Cut {
  VoxelPoints points;
  std::array<double, 3> spacing = {1, 1, 1};

  MaskGrid grid() const {
    MaskGrid grid = kGrid;
    grid.placement.spacing = spacing;
    return grid;
  }
  VoxelParts parts() const { return PartsOf(grid(), points); }
};
const Cut kCuts[] = {{VoxelPoints::kTwo},
                     {VoxelPoints::kSixteen},
                     {VoxelPoints::kTwo, {1, 1, 5}},
                     {VoxelPoints::kTwo, {16, 3, 1}},
                     {VoxelPoints::kSixteen, {1, 16, 16}}};

uint64_t BricksConverted(const LabeledObject& object, const Cut& cut,
                         MaskAdjacency adjacency = MaskAdjacency::k26) {
  const MaskOptions options = {.adjacency = adjacency, .points = cut.points};
  return ConvertLabel(cut.grid(), object, options, exec::Context())->volume.brick_count();
}

TEST(MostBricks, IsTheNumberOfBricksOfASolid) {
  for (int32_t low = 0; low < 9; ++low) {
    const LabeledObject box = ObjectOf([low](int32_t x, int32_t y, int32_t z) {
      return std::min({x, y, z}) >= low && x < 70 && y < 17 && z < 20;
    });
    for (const Cut& cut : kCuts) {
      const uint64_t bricks = BricksConverted(box, cut);
      EXPECT_GE(MostBricksOf(box, cut.parts()), bricks) << low;
      EXPECT_LE(MostBricksOf(box, cut.parts()), bricks + bricks / 2) << low;
    }
  }
}

TEST(MostBricks, IsNeverTooFew) {
  std::mt19937 random(7);
  for (double density : {0.001, 0.01, 0.1, 0.5}) {
    std::bernoulli_distribution here(density);
    for (int n = 0; n < 10; ++n) {
      const LabeledObject dust = ObjectOf([&](int32_t x, int32_t y, int32_t z) {
        return (x == 40 && y == 9 && z == 7) || here(random);
      });
      for (const MaskAdjacency adjacency : {MaskAdjacency::k26, MaskAdjacency::k6}) {
        for (const Cut& cut : kCuts) {
          EXPECT_GE(MostBricksOf(dust, cut.parts()), BricksConverted(dust, cut, adjacency));
        }
      }
    }
  }
}

TEST(MostBricks, OfAnyVoxelCoverIt) {
  for (int32_t x = 0; x < 17; ++x) {
    for (int32_t y = 0; y < 5; ++y) {
      for (int32_t z = 0; z < 9; ++z) {
        const LabeledObject voxel = ObjectOf(
            [=](int32_t vx, int32_t vy, int32_t vz) { return vx == x && vy == y && vz == z; });
        for (const Cut& cut : {kCuts[0], kCuts[1]}) {
          EXPECT_GE(MostBricksOf(voxel, cut.parts()), BricksConverted(voxel, cut));
          EXPECT_LE(MostBricksOf(voxel, cut.parts()), 16u);
        }
      }
    }
  }
}

LabelVolumeHeader Declared(int32_t edge, int label_bytes) {
  return {.grid = {.nx = edge, .ny = edge, .nz = edge}, .label_bytes = label_bytes};
}

TEST(LabelMemoryEstimate, TakesTheWorstForWhatIsNotStated) {
  const LabelVolumeHeader header = WithWorstCase(Declared(100, 2), 0);
  EXPECT_EQ(header.max_voxels, 1'000'000u);
  EXPECT_EQ(header.max_label_voxels, 1'000'000u);
  EXPECT_EQ(header.max_runs, 1'000'000u);
  EXPECT_EQ(header.max_labels, 65'535u);
  EXPECT_EQ(WithWorstCase(Declared(100, 2), 3).max_labels, 3u);
  EXPECT_EQ(WithWorstCase(Declared(100, 8), 0).max_labels, 1'000'000u);
}

TEST(LabelMemoryEstimate, GrowsWithEveryPromise) {
  LabelVolumeHeader base = Declared(512, 4);
  base.max_voxels = base.max_runs = 1'000'000;
  base.max_label_voxels = 1000;
  base.max_labels = 1000;
  const uint64_t bytes = BytesToSkeletonizeLabels(WithWorstCase(base, 0), 4);
  for (auto promise : {&LabelVolumeHeader::max_runs, &LabelVolumeHeader::max_label_voxels,
                       &LabelVolumeHeader::max_labels}) {
    LabelVolumeHeader less = base;
    less.*promise /= 2;
    EXPECT_LT(BytesToSkeletonizeLabels(WithWorstCase(less, 0), 4), bytes);
  }
  EXPECT_LT(BytesToSkeletonizeLabels(WithWorstCase(base, 0), 2), bytes);
}

TEST(LabelMemoryEstimate, OfAHostileExtentSaturatesInsteadOfWrapping) {
  const LabelVolumeHeader header = WithWorstCase(Declared(2'097'151, 8), 0);
  EXPECT_EQ(header.DecodedBytes(), std::numeric_limits<uint64_t>::max());
  EXPECT_GT(BytesToSkeletonizeLabels(header, 64), uint64_t{1} << 62);
}

}  // namespace
}  // namespace bccskel::server
