#include "tests/core/mask/mask_words.h"

#include <gtest/gtest.h>

#include <utility>

namespace bccskel::test {

MaskGrid GridOf(const ReferenceMask& mask, const Placement& placement) {
  return {mask.nx, mask.ny, mask.nz, placement};
}

std::vector<uint64_t> SliceWords(const ReferenceMask& mask, int32_t z) {
  const MaskGrid grid = GridOf(mask);
  std::vector<uint64_t> words(grid.WordsPerSlice());
  for (int32_t y = 0; y < mask.ny; ++y) {
    uint64_t* row = words.data() + static_cast<size_t>(y) * grid.WordsPerRow();
    for (int32_t x = 0; x < mask.nx; ++x) {
      if (mask.Contains(x, y, z)) row[x / 64] |= uint64_t{1} << x % 64;
    }
  }
  return words;
}

ConvertedMask Converted(const ReferenceMask& mask, const MaskOptions& options,
                        const Placement& placement) {
  auto converter = MaskConverter::Create(GridOf(mask, placement), options);
  EXPECT_TRUE(converter.ok()) << converter.status();
  for (int32_t z = 0; z < mask.nz; ++z) {
    const absl::Status status = converter->AddSlice(SliceWords(mask, z), {});
    EXPECT_TRUE(status.ok()) << status;
  }
  auto converted = std::move(*converter).Finish();
  EXPECT_TRUE(converted.ok()) << converted.status();
  return *std::move(converted);
}

ObjectReach ReachOf(MaskAdjacency adjacency) {
  return adjacency == MaskAdjacency::k26 ? ObjectReach::kCorner26 : ObjectReach::kFace6;
}

}  // namespace bccskel::test
