#include "client/export/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

namespace bccskel::exporting {
namespace {

absl::Status ErrnoStatus(const std::string& path) {
  const int error = errno;
  return absl::ErrnoToStatus(error, "cannot write " + path);
}

// Owns a file descriptor.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }
  bool Sync() const { return ::fsync(descriptor_) == 0; }
  bool Write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      bytes.remove_prefix(static_cast<size_t>(written));
    }
    return true;
  }
  // Some file systems report a full disk only here.
  bool Close() {
    const int descriptor = descriptor_;
    descriptor_ = -1;
    return ::close(descriptor) == 0;
  }

 private:
  int descriptor_;
};

bool IsSpecialFile(const std::string& path) {
  struct stat about;
  return ::stat(path.c_str(), &about) == 0 && !S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode);
}

absl::Status WriteDirectly(const std::string& path, std::string_view bytes) {
  OpenFile file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file.is_open() || !file.Write(bytes) || !file.Close()) return ErrnoStatus(path);
  return absl::OkStatus();
}

absl::Status WriteNewFile(const std::string& draft, const std::string& path,
                          std::string_view bytes) {
  OpenFile file(::open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!file.is_open() || !file.Write(bytes) || !file.Sync() || !file.Close()) {
    return ErrnoStatus(path);
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status WriteFileAtomically(const std::string& path, std::string_view bytes) {
  if (IsSpecialFile(path)) return WriteDirectly(path, bytes);
  const std::string draft = path + ".part" + std::to_string(::getpid());
  const absl::Status written = WriteNewFile(draft, path, bytes);
  if (written.ok() && std::rename(draft.c_str(), path.c_str()) == 0) return absl::OkStatus();
  const absl::Status error = written.ok() ? ErrnoStatus(path) : written;
  ::unlink(draft.c_str());
  return error;
}

}  // namespace bccskel::exporting
