// Any bytes as an image: an error or voxels that fit their size, never a crash or much memory.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <variant>
#include <vector>

#include "core/import/image/foreground.h"
#include "core/import/image/open_image.h"

namespace {

void ReadSlices(bccskel::ImageSource& source) {
  const bccskel::ImageSize& size = source.info().size;
  std::vector<uint64_t> words(bccskel::WordsPerRow(size.nx) * static_cast<size_t>(size.ny));
  std::vector<uint64_t> labels(size.SliceVoxels());
  for (int32_t z = 0; z < size.nz; ++z) {
    const auto slice = source.NextSlice();
    if (!slice.ok()) return;
    const bool whole = std::visit(
        [&labels](const auto values) { return values.size() == labels.size(); }, slice->values);
    if (!whole) std::abort();
    bccskel::ForegroundSlice(*slice, bccskel::ForegroundRule::NonZero(), words);
    bccskel::LabelSlice(*slice, labels).IgnoreError();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  bccskel::ImageOptions options;
  options.limits = {.max_axis_voxels = 4096,
                    .max_slice_voxels = 1 << 16,
                    .max_voxels = 1 << 20,
                    .max_header_bytes = 1 << 16};
  const auto source = bccskel::OpenImageBytes(
      "fuzz", std::string(reinterpret_cast<const char*>(data), size), options);
  if (source.ok()) ReadSlices(**source);
  return 0;
}
