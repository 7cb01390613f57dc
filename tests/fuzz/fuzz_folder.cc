// Any bytes as the metadata and the first chunk of an image that is a folder (a Zarr array,
// OME-Zarr, precomputed) or as two slices: an error or voxels that fit their size, never a crash or
// much memory. An input is files: a digit that says where a file goes, its bytes, and a NUL; the
// last one needs no NUL.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/import/image/open_image.h"
#include "tests/fuzz/read_image.h"

namespace {

constexpr std::array<const char*, 10> kPlaces = {".zarray",   ".zattrs", "0/.zarray",     "0.0.0",
                                                 "0/0.0.0.0", "info",    "1/0-4_0-3_0-2", "1.png",
                                                 "zarr.json", "c/0/0/0"};

// A folder of this process, in memory where the system has such a place.
const std::filesystem::path& Folder() {
  static const std::filesystem::path folder = [] {
    const std::filesystem::path memory = "/dev/shm";
    const auto base =
        std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
    return base / ("bccskel_fuzz_" + std::to_string(getpid()));
  }();
  return folder;
}

void WriteFiles(std::string_view input) {
  while (!input.empty()) {
    const auto place = static_cast<size_t>(input.front() - '0');
    const size_t end = input.find('\0', 1);
    // Chunks may hold any bytes, so they reach to the end.
    const bool chunk = place == 3 || place == 4 || place == 6 || place == 7 || place == 9;
    const std::string_view bytes =
        chunk || end == input.npos ? input.substr(1) : input.substr(1, end - 1);
    if (place < kPlaces.size()) {
      const std::filesystem::path path = Folder() / kPlaces[place];
      std::filesystem::create_directories(path.parent_path());
      std::ofstream(path, std::ios::binary) << bytes;
      if (place == 7) std::ofstream(Folder() / "2.png", std::ios::binary) << bytes;
    }
    input.remove_prefix(std::min(input.size(), bytes.size() + 2));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::filesystem::create_directories(Folder());
  WriteFiles({reinterpret_cast<const char*>(data), size});
  const auto source = bccskel::OpenImage(Folder().string(), bccskel::fuzz::SmallImages());
  if (source.ok()) bccskel::fuzz::ReadSlices(**source);
  std::filesystem::remove_all(Folder());
  return 0;
}
