#ifndef BCCSKEL_TESTS_FUZZ_READ_IMAGE_H_
#define BCCSKEL_TESTS_FUZZ_READ_IMAGE_H_

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <variant>
#include <vector>

#include "core/import/image/foreground.h"
#include "core/import/image/open_image.h"

namespace bccskel::fuzz {

inline ImageOptions SmallImages() {
  ImageOptions options;
  options.limits = {.max_axis_voxels = 4096,
                    .max_slice_voxels = 1 << 16,
                    .max_voxels = 1 << 20,
                    .max_header_bytes = 1 << 16,
                    .max_chunk_bytes = 1 << 22,
                    .max_chunk_slab_bytes = 1 << 22,
                    .max_chunks = 1 << 10};
  return options;
}

inline void ReadSlices(ImageSource& source) {
  const ImageSize& size = source.info().size;
  std::vector<uint64_t> words(WordsPerRow(size.nx) * static_cast<size_t>(size.ny));
  std::vector<uint64_t> labels(size.SliceVoxels());
  for (int32_t z = 0; z < size.nz; ++z) {
    const auto slice = source.NextSlice();
    if (!slice.ok()) return;
    const bool whole = std::visit(
        [&labels](const auto values) { return values.size() == labels.size(); }, slice->values);
    if (!whole) std::abort();
    ForegroundSlice(*slice, ForegroundRule::NonZero(), words);
    LabelSlice(*slice, labels).IgnoreError();
  }
}

}  // namespace bccskel::fuzz

#endif  // BCCSKEL_TESTS_FUZZ_READ_IMAGE_H_
