#include "tests/core/labels/label_volume.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>

namespace bccskel::test {
namespace {

size_t IndexOf(const MaskGrid& grid, int32_t x, int32_t y, int32_t z) {
  return static_cast<size_t>(z) * grid.VoxelsPerSlice() +
         static_cast<size_t>(y) * static_cast<size_t>(grid.nx) + static_cast<size_t>(x);
}

}  // namespace

uint64_t& LabelVolume::At(int32_t x, int32_t y, int32_t z) {
  return labels[IndexOf(grid, x, y, z)];
}

std::vector<uint64_t> LabelVolume::Slice(int32_t z) const {
  const auto first = labels.begin() + static_cast<ptrdiff_t>(IndexOf(grid, 0, 0, z));
  return {first, first + static_cast<ptrdiff_t>(grid.VoxelsPerSlice())};
}

ReferenceMask LabelVolume::MaskOf(uint64_t label) const {
  ReferenceMask mask{grid.nx, grid.ny, grid.nz, std::vector<uint8_t>(labels.size())};
  for (size_t n = 0; n < labels.size(); ++n) mask.voxels[n] = labels[n] == label ? 1 : 0;
  return mask;
}

LabelVolume EmptyLabels(int32_t nx, int32_t ny, int32_t nz, const Placement& placement) {
  const MaskGrid grid{nx, ny, nz, placement};
  return {grid, std::vector<uint64_t>(grid.VoxelsPerSlice() * static_cast<size_t>(nz))};
}

LabelVolume BallLabels(uint64_t seed, int32_t nx, int32_t ny, int32_t nz, int count,
                       double largest_radius) {
  LabelVolume volume = EmptyLabels(nx, ny, nz);
  std::mt19937_64 seeds(seed);
  for (int n = 1; n <= count; ++n) {
    const ReferenceMask ball = RandomBallMask(seeds(), nx, ny, nz, 3, largest_radius);
    for (size_t v = 0; v < ball.voxels.size(); ++v) {
      if (ball.voxels[v] != 0) volume.labels[v] = static_cast<uint64_t>(10 * n);
    }
  }
  return volume;
}

LabeledObjects Collected(const LabelVolume& volume, const LabelFilter& filter) {
  auto collector = LabelCollector::Create(volume.grid, filter);
  EXPECT_TRUE(collector.ok()) << collector.status();
  for (int32_t z = 0; z < volume.grid.nz; ++z) {
    const absl::Status status = collector->AddSlice(volume.Slice(z), {});
    EXPECT_TRUE(status.ok()) << status;
  }
  auto objects = std::move(*collector).Finish();
  EXPECT_TRUE(objects.ok()) << objects.status();
  return *std::move(objects);
}

}  // namespace bccskel::test
