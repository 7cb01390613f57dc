#ifndef BCCSKEL_SERVER_STORE_FOLDER_LOCK_H_
#define BCCSKEL_SERVER_STORE_FOLDER_LOCK_H_

#include <string>

#include "absl/status/statusor.h"
#include "server/store/file_io.h"

namespace bccskel::server {

// The right to a data folder: one process has it at a time, until it ends, however it ends. Works
// on file systems where flock() does; do not share the folder over a network.
class FolderLock {
 public:
  // Errors: ALREADY_EXISTS when another process has it.
  static absl::StatusOr<FolderLock> Take(const std::string& folder);

 private:
  explicit FolderLock(File file) : file_(std::move(file)) {}
  File file_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_FOLDER_LOCK_H_
