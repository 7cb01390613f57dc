#include "server/store/data_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/store/file_io.h"

namespace bccskel::server {
namespace {

constexpr size_t kMostIdBytes = 256;

// Enough for several hundred changes of the tables and for SQLite's cleanup after them.
constexpr off_t kReserveBytes = off_t{1} << 20;

}  // namespace

absl::StatusOr<FolderLock> FolderLock::Take(const std::string& path, With with) {
  BCCSKEL_ASSIGN_OR_RETURN(File folder, File::OpenToRead(path));
  BCCSKEL_ASSIGN_OR_RETURN(File file, File::OpenToWrite(path + "/lock"));
  const int kind = with == With::kNobody ? LOCK_EX : LOCK_SH;
  // Not every file system that locks files also locks folders.
  bool taken = flock(folder.fd(), kind | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (flock(file.fd(), kind | LOCK_NB) != 0 && (kind == LOCK_EX || errno == EWOULDBLOCK)) {
    taken = true;
  }
  if (taken) {
    return absl::AlreadyExistsError(absl::StrCat("another server owns the data directory ", path));
  }
  BCCSKEL_ASSIGN_OR_RETURN(std::string store_id, file.ReadAt(0, kMostIdBytes));
  return FolderLock(std::move(folder), std::move(file), std::move(store_id));
}

absl::Status FolderLock::SetStoreId(const std::string& id) {
  BCCSKEL_RETURN_IF_ERROR(file_.WriteAt(0, id));
  BCCSKEL_RETURN_IF_ERROR(file_.Truncate(id.size()));
  BCCSKEL_RETURN_IF_ERROR(file_.Sync());
  store_id_ = id;
  return absl::OkStatus();
}

void FolderLock::Touch(std::chrono::system_clock::time_point now) {
  const timespec time = {.tv_sec = std::chrono::system_clock::to_time_t(now), .tv_nsec = 0};
  const timespec both[] = {time, time};
  futimens(file_.fd(), both);  // best effort: without it the next start believes its clock less
}

void DiskReserve::Hold() {
  if (held_) return;
  const auto file = File::OpenToWrite(path_);
  held_ = file.ok() && posix_fallocate(file->fd(), 0, kReserveBytes) == 0;
  if (!held_) Release();
}

void DiskReserve::Release() {
  held_ = false;
  RemoveFile(path_).IgnoreError();
}

}  // namespace bccskel::server
