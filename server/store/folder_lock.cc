#include "server/store/folder_lock.h"

#include <sys/file.h>

#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"

namespace bccskel::server {

absl::StatusOr<FolderLock> FolderLock::Take(const std::string& folder) {
  BCCSKEL_ASSIGN_OR_RETURN(File file, File::OpenToWrite(folder + "/lock"));
  if (flock(file.fd(), LOCK_EX | LOCK_NB) == 0) return FolderLock(std::move(file));
  return absl::AlreadyExistsError(absl::StrCat("another server owns the data directory ", folder,
                                               " (it holds ", file.path(), ")"));
}

}  // namespace bccskel::server
