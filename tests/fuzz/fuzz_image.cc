// Any bytes as an image: an error or voxels that fit their size, never a crash or much memory.
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/import/image/open_image.h"
#include "tests/fuzz/read_image.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto source = bccskel::OpenImageBytes(
      "fuzz", std::string(reinterpret_cast<const char*>(data), size), bccskel::fuzz::SmallImages());
  if (source.ok()) bccskel::fuzz::ReadSlices(**source);
  return 0;
}
