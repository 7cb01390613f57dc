#ifndef BCCSKEL_TESTS_QUALITY_VOXEL_MASK_H_
#define BCCSKEL_TESTS_QUALITY_VOXEL_MASK_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/mask/mask_grid.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::quality {

using Voxel = std::array<int32_t, 3>;

// A cubic mask as the project's conversion takes it, a bit a voxel.
class VoxelMask {
 public:
  explicit VoxelMask(const MaskGrid& grid)
      : grid_(grid), words_(grid.WordsPerSlice() * static_cast<size_t>(grid.nz)) {}

  const MaskGrid& grid() const { return grid_; }
  bool IsInside(Voxel v) const {
    return v[0] >= 0 && v[1] >= 0 && v[2] >= 0 && v[0] < grid_.nx && v[1] < grid_.ny &&
           v[2] < grid_.nz;
  }
  // False outside the grid.
  bool Holds(Voxel v) const {
    return IsInside(v) && (words_[WordOf(v)] >> (static_cast<unsigned>(v[0]) % 64) & 1) != 0;
  }
  void Flip(Voxel v) { words_[WordOf(v)] ^= uint64_t{1} << static_cast<unsigned>(v[0]) % 64; }
  std::span<uint64_t> Slice(int32_t z) {
    return std::span(words_).subspan(static_cast<size_t>(z) * grid_.WordsPerSlice(),
                                     grid_.WordsPerSlice());
  }
  uint64_t Count() const;

  template <typename Visit>
  void ForEachVoxel(Visit visit) const {
    for (int32_t z = 0; z < grid_.nz; ++z) {
      for (int32_t y = 0; y < grid_.ny; ++y) {
        for (int32_t x = 0; x < grid_.nx; ++x) {
          if (Holds({x, y, z})) visit(Voxel{x, y, z});
        }
      }
    }
  }

 private:
  size_t WordOf(Voxel v) const {
    return static_cast<size_t>(v[2]) * grid_.WordsPerSlice() +
           static_cast<size_t>(v[1]) * grid_.WordsPerRow() + static_cast<size_t>(v[0]) / 64;
  }

  MaskGrid grid_;
  std::vector<uint64_t> words_;
};

// The default conversion of the project, and its default settings for objects of that origin.
struct MaskObject {
  Volume volume;
  SkeletonizeOptions options;
};
absl::StatusOr<MaskObject> Convert(VoxelMask& mask, const SkeletonizeOptions& options);

// As for volumes (disturb.h), in the reading (26, 6).
VoxelMask WithTopologyKeepingNoise(VoxelMask mask, double fraction, uint64_t seed);

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_VOXEL_MASK_H_
