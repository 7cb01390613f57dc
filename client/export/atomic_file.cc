#include "client/export/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace bccskel::exporting {
namespace {

absl::Status ErrnoStatus(const std::string& path) {
  const int error = errno;
  const std::string message = "cannot write " + path, folder = path.substr(0, path.rfind('/') + 1);
  std::error_code ignored;
  if (error == ENOENT && !folder.empty() && !std::filesystem::exists(folder, ignored)) {
    return absl::NotFoundError(message + ": the folder " + folder.substr(0, folder.size() - 1) +
                               " does not exist; create it first");
  }
  return absl::ErrnoToStatus(error, message);
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
  bool Write(std::string_view bytes, const std::stop_token& stop) const {
    constexpr size_t kMostAtOnce = size_t{1} << 22;  // so that a stop takes effect
    while (!bytes.empty() && !stop.stop_requested()) {
      const ssize_t written =
          ::write(descriptor_, bytes.data(), std::min(bytes.size(), kMostAtOnce));
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

bool IsFolder(const std::string& path) {
  struct stat about;
  return ::stat(path.c_str(), &about) == 0 && S_ISDIR(about.st_mode);
}

bool IsSpecialFile(const std::string& path) {
  struct stat about;
  return ::stat(path.c_str(), &about) == 0 && !S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode);
}

absl::Status StopStatus(const std::string& path, const std::stop_token& stop) {
  return stop.stop_requested() ? absl::CancelledError(path + ": not written") : absl::OkStatus();
}

absl::Status WriteDirectly(const std::string& path, std::string_view bytes,
                           const std::stop_token& stop) {
  OpenFile file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file.is_open() || !file.Write(bytes, stop) || !file.Close()) return ErrnoStatus(path);
  return StopStatus(path, stop);
}

OpenFile OpenNewFile(const std::string& path) {
  return OpenFile(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
}

absl::Status WriteNewFile(const std::string& draft, const std::string& path, std::string_view bytes,
                          const std::stop_token& stop) {
  OpenFile file = OpenNewFile(draft);
  if (!file.is_open() || !file.Write(bytes, stop)) return ErrnoStatus(path);
  if (stop.stop_requested()) return StopStatus(path, stop);
  if (!file.Sync() || !file.Close()) return ErrnoStatus(path);
  return StopStatus(path, stop);
}

// Follows links, so that a link stays and its target is replaced.
std::string BehindLinks(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const std::filesystem::path behind = std::filesystem::canonical(path, error);
  return error ? path : behind.string();
}

std::string DraftOf(const std::string& path) { return path + ".part" + std::to_string(::getpid()); }

}  // namespace

absl::Status WriteFileAtomically(const std::string& path, std::string_view bytes,
                                 const std::stop_token& stop) {
  if (IsSpecialFile(path)) return WriteDirectly(path, bytes, stop);
  const std::string place = BehindLinks(path), draft = DraftOf(place);
  const absl::Status written = WriteNewFile(draft, path, bytes, stop);
  if (written.ok() && std::rename(draft.c_str(), place.c_str()) == 0) return absl::OkStatus();
  absl::Status error = written.ok() ? ErrnoStatus(path) : written;
  ::unlink(draft.c_str());
  return error;
}

absl::Status CheckWritable(const std::string& path) {
  // Opening a pipe would wait for its reader.
  if (IsSpecialFile(path)) {
    return ::access(path.c_str(), W_OK) == 0 ? absl::OkStatus() : ErrnoStatus(path);
  }
  if (IsFolder(path)) {
    errno = EISDIR;
    return ErrnoStatus(path);
  }
  const std::string draft = DraftOf(BehindLinks(path));
  if (!OpenNewFile(draft).is_open()) return ErrnoStatus(path);
  ::unlink(draft.c_str());
  return absl::OkStatus();
}

}  // namespace bccskel::exporting
