// Limbs of masks whose slices are five times as thick as voxels are wide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/pipeline/skeletonize.h"
#include "core/skeleton/skeleton_figures.h"
#include "tests/core/mask/mask_words.h"

namespace bccskel {
namespace {

constexpr double kSlice = 5;
constexpr double kTrunk = 6, kTwig = 2.2;  // radii

// The ends of a trunk along x with three twigs along z that stick out of it this far.
uint64_t EndsWithTwigs(double length) {
  Placement placement;
  placement.spacing = {1, 1, kSlice};
  const auto mask = test::MaskWhere(90, 31, 15, [length](int32_t x, int32_t y, int32_t z) {
    const double up = kSlice * (z - 5), aside = y - 15, along = x - 10;
    bool inside = std::hypot(along - std::clamp(along, 0.0, 70.0), aside, up) <= kTrunk;
    for (const double at : {15.0, 35.0, 55.0}) {
      const double above = up - std::clamp(up, 0.0, kTrunk + length);
      inside = inside || std::hypot(along - at, aside, above) <= kTwig;
    }
    return inside;
  });
  const Volume object = Converted(mask, {}, placement).volume;
  const SkeletonizeOptions options = {
      .source = ObjectSource::kVoxels,
      .voxel_slabs = SlabsOf(test::GridOf(mask, placement), VoxelPoints::kTwo)};
  const auto result = Skeletonize(object, options, {});
  return TotalOf(ComponentsOf(result->graph)).ends;
}

TEST(ThickSlices, LoseNoTwigOfThreeSlices) {
  for (const double slices : {3.0, 3.5, 4.0}) {
    EXPECT_EQ(EndsWithTwigs(slices * kSlice), 5u) << slices;
  }
}

// A single slice may be noise.
TEST(ThickSlices, HaveNoTwigsOfOneSlice) { EXPECT_EQ(EndsWithTwigs(kSlice), 2u); }

}  // namespace
}  // namespace bccskel
