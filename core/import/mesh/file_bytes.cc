#include "core/import/mesh/file_bytes.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <memory>
#include <new>
#include <system_error>

#include "absl/strings/str_format.h"

namespace bccskel {
namespace {

constexpr size_t kReadBytes = size_t{1} << 18;

struct CloseGzFile {
  void operator()(gzFile file) const { gzclose_r(file); }
};
using GzFile = std::unique_ptr<gzFile_s, CloseGzFile>;

absl::Status DamagedError(const std::string& path, gzFile file) {
  int code = Z_OK;
  const char* text = gzerror(file, &code);
  if (code == Z_ERRNO) {
    return absl::ErrnoToStatus(errno, absl::StrFormat("cannot read '%s'", path));
  }
  return absl::InvalidArgumentError(
      absl::StrFormat("'%s' is a damaged or cut gzip stream: %s", path, text));
}

// Reads to the end; at the end of input gzerror() reports whether the stream was complete.
absl::StatusOr<std::string> ReadAll(const std::string& path, gzFile file, uint64_t max_bytes) {
  std::string bytes;
  while (true) {
    const size_t filled = bytes.size();
    bytes.resize(filled + kReadBytes);
    const int got = gzread(file, bytes.data() + filled, static_cast<unsigned>(kReadBytes));
    if (got < 0) return DamagedError(path, file);
    bytes.resize(filled + static_cast<size_t>(got));
    if (bytes.size() > max_bytes) {
      return absl::ResourceExhaustedError(
          absl::StrFormat("'%s' holds more than the limit of %d bytes", path, max_bytes));
    }
    if (got < static_cast<int>(kReadBytes)) break;
  }
  int code = Z_OK;
  gzerror(file, &code);
  if (code != Z_OK) return DamagedError(path, file);
  return bytes;
}

}  // namespace

absl::StatusOr<std::string> ReadFileBytes(const std::string& path, uint64_t max_bytes) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return absl::InvalidArgumentError(absl::StrFormat("'%s' is a folder, not a file", path));
  }
  errno = 0;
  const GzFile file(gzopen(path.c_str(), "rb"));
  if (file == nullptr) {
    return absl::ErrnoToStatus(errno == 0 ? ENOMEM : errno,
                               absl::StrFormat("cannot open '%s'", path));
  }
  try {
    return ReadAll(path, file.get(), max_bytes);
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError(absl::StrFormat("not enough memory to read '%s'", path));
  }
}

}  // namespace bccskel
