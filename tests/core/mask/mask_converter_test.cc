// What a converter refuses, and what samplings do.
#include "core/mask/mask_converter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "tests/core/mask/mask_words.h"
#include "tests/support/contexts.h"
#include "tests/support/object_parts.h"
#include "tests/support/reference_mask.h"

namespace bccskel {
namespace {

using test::Converted;
using test::ReferenceMask;
using ::testing::HasSubstr;

absl::Status StatusOfSlices(const MaskGrid& grid, const std::vector<std::vector<uint64_t>>& slices,
                            const MaskOptions& options = {}, const exec::Context& context = {}) {
  auto converter = MaskConverter::Create(grid, options);
  if (!converter.ok()) return converter.status();
  for (const std::vector<uint64_t>& slice : slices) {
    if (absl::Status status = converter->AddSlice(slice, context); !status.ok()) return status;
  }
  return std::move(*converter).Finish().status();
}

TEST(MaskConverter, NamesAnAxisThatIsTooLongOrMissing) {
  for (const MaskGrid& grid : {MaskGrid{0, 4, 4, {}}, MaskGrid{4, kMaxMaskVoxels + 1, 4, {}}}) {
    const absl::Status status = StatusOfSlices(grid, {});
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(status.message(), HasSubstr("1 to 2097151"));
  }
}

TEST(MaskConverter, RefusesASpacingOfZero) {
  MaskGrid grid = {4, 4, 4, {}};
  grid.placement.spacing[1] = 0;
  EXPECT_EQ(StatusOfSlices(grid, {}).code(), absl::StatusCode::kInvalidArgument);
}

TEST(MaskConverter, RefusesSlicesOfTheWrongSize) {
  const absl::Status status = StatusOfSlices({65, 2, 1, {}}, {{1, 0, 1}});
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), HasSubstr("65 x 2 voxels take 4"));
}

TEST(MaskConverter, RefusesABitPastTheLastVoxelOfARow) {
  const absl::Status status = StatusOfSlices({3, 2, 1, {}}, {{0b111, 0b1000}});
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), HasSubstr("slice 0, row 1"));
}

TEST(MaskConverter, PartsAreTheWholeTogetherAndKnowTheWholeTopology) {
  const ReferenceMask mask = test::RandomMask(5, 60, 40, 70, 0.4);
  std::vector<MaskOptions> all;
  for (const MaskAdjacency adjacency : test::kBothAdjacencies) {
    all.push_back({.adjacency = adjacency});
    all.push_back({.adjacency = adjacency, .points = VoxelPoints::kSixteen});
  }
  all.push_back({.sampling = MaskSamplingOptions{}});
  for (const MaskOptions& options : all) {
    const ConvertedMask whole = Converted(mask, options);
    std::vector<Volume> parts;
    for (int32_t index = 0; index < 3; ++index) {
      MaskOptions chosen = options;
      chosen.part = {index, 3};
      ConvertedMask part = Converted(mask, chosen);
      EXPECT_EQ(part.mask, whole.mask);
      EXPECT_EQ(part.voxels, whole.voxels);
      EXPECT_LT(part.volume.brick_count(), whole.volume.brick_count());
      parts.push_back(std::move(part.volume));
    }
    EXPECT_EQ(*test::Joined(parts), whole.volume);
  }
}

TEST(MaskConverter, RefusesTooFewAndTooManySlices) {
  EXPECT_THAT(StatusOfSlices({1, 1, 2, {}}, {{1}}).message(), HasSubstr("after 1 of 2 slices"));
  EXPECT_THAT(StatusOfSlices({1, 1, 1, {}}, {{1}, {1}}).message(), HasSubstr("more than the 1"));
}

TEST(MaskConverter, StopsAtTheLimitOfBricks) {
  const MaskGrid grid = {64, 1, 1, {}};
  const absl::Status status = StatusOfSlices(grid, {{~uint64_t{0}}}, {.max_bricks = 4});
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
}

TEST(MaskConverter, StopsWhenCancelled) {
  const exec::Context context = test::Stopped();
  EXPECT_EQ(StatusOfSlices({1, 1, 1, {}}, {{1}}, {}, context).code(), absl::StatusCode::kCancelled);
}

TEST(MaskConverter, CountsVoxels) {
  const ReferenceMask mask = test::RandomMask(5, 70, 9, 8, 0.4);
  uint64_t voxels = 0;
  for (uint8_t voxel : mask.voxels) voxels += voxel;
  EXPECT_EQ(Converted(mask, {}).voxels, voxels);
}

MaskOptions Sampled(MaskWeights weights, double points_per_voxel) {
  return {.sampling =
              MaskSamplingOptions{.weights = weights, .points_per_voxel = points_per_voxel}};
}

// The sampling by its definition, point by point.
bool SampleOf(const ReferenceMask& mask, MaskWeights weights, const std::array<double, 3>& at) {
  std::array<int32_t, 3> lower = {};
  std::array<double, 3> upper = {};
  for (size_t axis = 0; axis < 3; ++axis) {
    const bool nearest = weights == MaskWeights::kNearest;
    lower[axis] = static_cast<int32_t>(std::floor(nearest ? at[axis] + 0.5 : at[axis]));
    upper[axis] = nearest ? 0 : at[axis] - lower[axis];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    if (!mask.Contains(lower[0] + x, lower[1] + y, lower[2] + z)) continue;
    sum += (x != 0 ? upper[0] : 1 - upper[0]) * (y != 0 ? upper[1] : 1 - upper[1]) *
           (z != 0 ? upper[2] : 1 - upper[2]);
  }
  return sum >= 0.5;
}

TEST(MaskSampling, IsThatOfItsDefinition) {
  for (double density : {0.02, 0.5}) {
    const ReferenceMask mask = test::RandomMask(11, 67, 14, 11, density);
    for (MaskWeights weights : {MaskWeights::kNearest, MaskWeights::kTrilinear}) {
      // Densities at which no point lies midway between voxels up to rounding.
      for (double points_per_voxel : {0.7, 2.3, 17.0}) {
        SCOPED_TRACE(points_per_voxel);
        const MaskOptions options = Sampled(weights, points_per_voxel);
        const Volume volume = Converted(mask, options).volume;
        const auto lattice = LatticeFor(test::GridOf(mask), *options.sampling);
        ASSERT_TRUE(lattice.ok());
        const LatticeExtent extent = lattice->extent;
        for (int32_t z = 0; z < 2 * extent.nz; ++z) {
          for (int32_t y = z & 1; y < 2 * extent.ny; y += 2) {
            for (int32_t x = z & 1; x < 2 * extent.nx; x += 2) {
              const std::array<double, 3> at = {lattice->first[0] + lattice->step[0] * x,
                                                lattice->first[1] + lattice->step[1] * y,
                                                lattice->first[2] + lattice->step[2] * z};
              ASSERT_EQ(volume.Contains({x, y, z}), SampleOf(mask, weights, at))
                  << x << " " << y << " " << z;
            }
          }
        }
      }
    }
  }
}

TEST(MaskSampling, HasTheWantedDensityAndTheWorldCoordinatesOfTheImage) {
  const Placement image = {{1, 2, 4}, {5, 6, 7}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  const ReferenceMask mask = test::RandomMask(1, 40, 40, 40, 1);
  const Volume volume = Converted(mask, Sampled(MaskWeights::kNearest, 3), image).volume;
  EXPECT_NEAR(static_cast<double>(volume.PointCount()), 3 * 64000, 0.06 * 3 * 64000);
  const auto& spacing = volume.placement().spacing;
  EXPECT_NEAR(spacing[2] / spacing[0], 4, 1e-12);
  WorldPoint sum = {};
  volume.ForEachPoint([&](LatticePoint p) {
    for (size_t axis = 0; axis < 3; ++axis) sum[axis] += volume.placement().ToWorld(p)[axis];
  });
  for (size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sum[axis] / static_cast<double>(volume.PointCount()),
                image.origin[axis] + 19.5 * image.spacing[axis], 1e-9);
  }
}

TEST(MaskSampling, ReportsWhatItChanged) {
  const ReferenceMask mask = test::RandomMask(2, 30, 30, 30, 0.3);
  const ConvertedMask sampled = Converted(mask, Sampled(MaskWeights::kTrilinear, 2));
  EXPECT_EQ(sampled.mask, test::ReferenceMaskBetti(mask, test::ObjectReach::kCorner26));
  const auto object = CountBettiNumbers(sampled.volume, {});
  ASSERT_TRUE(object.ok());
  EXPECT_THAT(DescribeChanges(sampled.mask, *object), HasSubstr("loops"));
  EXPECT_EQ(DescribeChanges({1, 2, 3}, {1, 3, 4}), "loops 2 -> 3, cavities 3 -> 4");
  EXPECT_EQ(DescribeChanges({1, 2, 3}, {1, 2, 3}), "");
}

TEST(MaskSampling, RefusesDensitiesOutOfRange) {
  for (double density : {0.0, 1e9, std::nan("")}) {
    const absl::Status status =
        StatusOfSlices({4, 4, 4, {}}, {}, Sampled(MaskWeights::kNearest, density));
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(status.message(), HasSubstr("points_per_voxel"));
  }
}

TEST(MaskSampling, StopsAtTheLimitOfBricks) {
  MaskOptions options = Sampled(MaskWeights::kNearest, 16);
  options.max_bricks = 2;
  EXPECT_EQ(StatusOfSlices({64, 1, 1, {}}, {{~uint64_t{0}}}, options).code(),
            absl::StatusCode::kResourceExhausted);
}

}  // namespace
}  // namespace bccskel
