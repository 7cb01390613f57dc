#include "server/socket_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "absl/strings/str_cat.h"

namespace bccskel::server {
namespace {

constexpr int kOwnerOnly = 0600;

// The locked file is still the one that the path names: whoever had the lock before may have
// removed it between our open and our lock.
bool IsNamedBy(int file, const std::string& path) {
  struct stat opened = {}, named = {};
  return fstat(file, &opened) == 0 && stat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace

absl::StatusOr<SocketLock> SocketLock::Take(const std::string& socket_path) {
  const std::string path = socket_path + ".lock";
  while (true) {
    const int file = open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, kOwnerOnly);
    if (file < 0) {
      return absl::InvalidArgumentError(
          absl::StrCat("cannot make ", path, ": ", std::strerror(errno)));
    }
    SocketLock lock(path, file);
    if (flock(file, LOCK_EX | LOCK_NB) != 0) {
      close(std::exchange(lock.file_, -1));
      return absl::AlreadyExistsError(
          absl::StrCat("another server listens on unix:", socket_path, " (it holds ", path, ")"));
    }
    if (IsNamedBy(file, path)) return lock;
    close(std::exchange(lock.file_, -1));
  }
}

SocketLock::SocketLock(SocketLock&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

SocketLock::~SocketLock() {
  if (file_ < 0) return;
  unlink(path_.c_str());  // before the lock goes: afterwards the file may be another server's
  close(file_);
}

}  // namespace bccskel::server
