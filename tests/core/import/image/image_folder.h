#ifndef BCCSKEL_TESTS_CORE_IMPORT_IMAGE_IMAGE_FOLDER_H_
#define BCCSKEL_TESTS_CORE_IMPORT_IMAGE_IMAGE_FOLDER_H_

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_replace.h"
#include "tests/core/import/image/image_bytes.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::testing {

// An image that is a folder, written file by file; it is gone with its owner.
class ImageFolder {
 public:
  explicit ImageFolder(const std::string& name) : path_(parent_ / name) {
    std::filesystem::create_directories(path_);
  }

  void Write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path path = std::filesystem::path(path_) / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
  }
  absl::StatusOr<ReadImage> Read(const ImageOptions& options = {}) const {
    return ReadAll(OpenImage(path_, options));
  }
  const std::string& path() const { return path_; }

 private:
  const test::TemporaryFolder parent_;
  const std::string path_;
};

using Replacements = std::vector<std::pair<std::string, std::string>>;

// The text with parts replaced one after the other; each must be in it.
inline std::string Replaced(std::string text, const Replacements& replacements) {
  for (const auto& [from, to] : replacements) {
    EXPECT_NE(text.find(from), text.npos) << from;
    text = absl::StrReplaceAll(text, {{from, to}});
  }
  return text;
}

inline std::string ErrorOf(const ImageFolder& folder, const ImageOptions& options = {}) {
  const auto image = folder.Read(options);
  return image.ok() ? "read" : std::string(image.status().ToString());
}

// Reads the folder with each byte of one of its files changed, and with the file cut at each byte,
// which must be an error. Returns how many changes can be read. The file holds `bytes` in the end.
inline int ReadsOfDamaged(const ImageFolder& folder, const std::string& name,
                          const std::string& bytes, const ImageOptions& options) {
  int read = 0;
  for (size_t at = 0; at < bytes.size(); ++at) {
    for (const char byte : {'9', '\xff'}) {
      std::string changed = bytes;
      changed[at] = byte;
      folder.Write(name, changed);
      read += folder.Read(options).ok() ? 1 : 0;
    }
    folder.Write(name, bytes.substr(0, at));
    EXPECT_FALSE(folder.Read(options).ok()) << at;
  }
  folder.Write(name, bytes);
  return read;
}

}  // namespace bccskel::testing

#endif  // BCCSKEL_TESTS_CORE_IMPORT_IMAGE_IMAGE_FOLDER_H_
