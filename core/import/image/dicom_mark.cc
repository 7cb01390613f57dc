#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "core/import/image/image_readers.h"

namespace bccskel {

bool IsDicomFile(const std::string& path) {
  std::error_code none;  // a pipe would wait for its writer
  if (!std::filesystem::is_regular_file(path, none)) return false;
  constexpr std::streamoff kPreamble = 128;
  constexpr std::string_view kMark = "DICM";
  std::array<char, kMark.size()> found = {};
  std::ifstream file(path, std::ios::binary);
  file.seekg(kPreamble);
  file.read(found.data(), found.size());
  return file.good() && std::ranges::equal(found, kMark);
}

bool IsDicomFolder(const std::string& path) {
  std::error_code error;
  for (std::filesystem::directory_iterator entry(path, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_regular_file(ignored) && IsDicomFile(entry->path().string())) return true;
  }
  return false;
}

}  // namespace bccskel
