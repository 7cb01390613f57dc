#ifndef BCCSKEL_TESTS_CORE_LABELS_VOXEL_FIGURE_H_
#define BCCSKEL_TESTS_CORE_LABELS_VOXEL_FIGURE_H_

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/labels/convert_label.h"
#include "core/mask/mask_converter.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::test {

using Voxel = std::array<int32_t, 3>;

// The exact conversion of the voxels for which `is_in` returns true.
template <typename IsIn>
Volume ConversionOf(const MaskGrid& grid, const MaskOptions& mask, const IsIn& is_in) {
  auto converter = *MaskConverter::Create(grid, mask);
  for (int32_t z = 0; z < grid.nz; ++z) {
    std::vector<uint64_t> words(grid.WordsPerSlice());
    for (int32_t y = 0; y < grid.ny; ++y) {
      for (int32_t x = 0; x < grid.nx; ++x) {
        if (!is_in(Voxel{x, y, z})) continue;
        const size_t word =
            static_cast<size_t>(y) * grid.WordsPerRow() + static_cast<size_t>(x) / 64;
        words[word] |= uint64_t{1} << x % 64;
      }
    }
    EXPECT_TRUE(converter.AddSlice(words, {}).ok());
  }
  return std::move((*std::move(converter).Finish()).volume);
}

// And their skeleton.
template <typename IsIn>
SkeletonizeResult SkeletonOf(const MaskGrid& grid, const SkeletonizeOptions& options,
                             const MaskOptions& mask, const IsIn& is_in) {
  const Volume object = ConversionOf(grid, mask, is_in);
  auto result = Skeletonize(object, ForMask(options, grid, mask), {});
  EXPECT_TRUE(result.ok()) << result.status();
  return *std::move(result);
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_LABELS_VOXEL_FIGURE_H_
