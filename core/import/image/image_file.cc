#include "core/import/image/image_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "absl/strings/str_format.h"

namespace bccskel {
namespace {

absl::Status SystemError(const char* what, const std::string& path) {
  return absl::ErrnoToStatus(errno, absl::StrFormat("cannot %s '%s'", what, path));
}

}  // namespace

absl::StatusOr<std::shared_ptr<const ImageFile>> ImageFile::Open(const std::string& path) {
  // A pipe would wait for its writer.
  exec::Descriptor descriptor(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!descriptor.is_open()) return SystemError("open", path);
  struct stat status = {};
  if (fstat(descriptor.get(), &status) != 0) return SystemError("read", path);
  if (!S_ISREG(status.st_mode)) {
    return absl::InvalidArgumentError(
        S_ISDIR(status.st_mode)
            ? absl::StrFormat("'%s' is a folder; images are read from regular files", path)
            : absl::StrFormat("%s: is a pipe or a device, which cannot be read twice; save it to a "
                              "file first",
                              path));
  }
  const auto size = static_cast<uint64_t>(status.st_size);
  return std::shared_ptr<const ImageFile>(new ImageFile(path, std::move(descriptor), size, ""));
}

std::shared_ptr<const ImageFile> ImageFile::OfBytes(std::string name, std::string bytes) {
  const uint64_t size = bytes.size();
  return std::shared_ptr<const ImageFile>(
      new ImageFile(std::move(name), {}, size, std::move(bytes)));
}

absl::StatusOr<std::shared_ptr<const ImageFile>> ImageFile::OpenBeside(
    const std::string& name) const {
  const std::string plain = name.starts_with("./") ? name.substr(2) : name;
  if (plain.empty() || plain == "." || plain == ".." || plain.find('/') != plain.npos ||
      plain.find('\0') != plain.npos) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "the header names '%s' for its voxels; only a file beside the header is read", name));
  }
  if (!descriptor_.is_open()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the header names the file '%s' for its voxels, but is in memory", name));
  }
  return Open(name_.substr(0, name_.rfind('/') + 1) + plain);
}

absl::StatusOr<size_t> ImageFile::ReadAt(uint64_t offset, std::span<std::byte> into) const {
  if (offset >= size_) return size_t{0};
  const auto wanted = static_cast<size_t>(std::min<uint64_t>(into.size(), size_ - offset));
  if (!descriptor_.is_open()) {
    std::memcpy(into.data(), bytes_.data() + offset, wanted);
    return wanted;
  }
  size_t filled = 0;
  while (filled < wanted) {
    const ssize_t got = pread(descriptor_.get(), into.data() + filled, wanted - filled,
                              static_cast<off_t>(offset + filled));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return SystemError("read", name_);
    if (got == 0) break;
    filled += static_cast<size_t>(got);
  }
  return filled;
}

}  // namespace bccskel
