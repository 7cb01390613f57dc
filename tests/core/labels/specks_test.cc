// A preset drops the same specks of voxels however many lattice points make a voxel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "core/pipeline/presets.h"
#include "tests/core/labels/voxel_figure.h"

namespace bccskel {
namespace {

using test::Voxel;

// How many of four separate blocks stay: of 27, 64, 100 and 125 voxels.
int64_t StayingBlocks(const SkeletonizeOptions& options, const MaskOptions& mask, double slice) {
  constexpr std::array<std::array<int32_t, 3>, 4> kBlocks = {
      {{3, 3, 3}, {4, 4, 4}, {5, 5, 4}, {5, 5, 5}}};
  MaskGrid grid = {.nx = 40, .ny = 8, .nz = 8};
  grid.placement.spacing = {1, 1, slice};
  const SkeletonizeResult result = test::SkeletonOf(grid, options, mask, [&](const Voxel& at) {
    const size_t block = static_cast<size_t>(at[0] / 10);
    const Voxel in = {at[0] % 10 - 1, at[1] - 1, at[2] - 1};
    for (size_t axis = 0; axis < 3; ++axis) {
      if (in[axis] < 0 || in[axis] >= kBlocks[block][axis]) return false;
    }
    return true;
  });
  return result.certificate.skeleton.components;
}

TEST(Specks, AreTheSameForPresetsAtAnyNumberOfPointsPerVoxel) {
  for (const char* preset : {"neuron", "vessels", "materials"}) {
    SkeletonizeOptions options;
    ASSERT_TRUE(ApplyPreset(preset, options).ok());
    for (const double slice : {1.0, 2.0, 4.0, 8.0}) {
      for (const VoxelPoints points : {VoxelPoints::kTwo, VoxelPoints::kSixteen}) {
        EXPECT_EQ(StayingBlocks(options, {.points = points}, slice), 2)
            << preset << ", slices of " << slice;
      }
    }
  }
}

TEST(Specks, AreCountedInLatticePointsWhereTheUserStatesThem) {
  const SkeletonizeOptions options = {.preparing = {.min_component_points = 200}};
  EXPECT_EQ(StayingBlocks(options, {}, 1), 2);
  EXPECT_EQ(StayingBlocks(options, {.points = VoxelPoints::kSixteen}, 1), 4);
}

}  // namespace
}  // namespace bccskel
