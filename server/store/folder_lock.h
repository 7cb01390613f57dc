#ifndef BCCSKEL_SERVER_STORE_FOLDER_LOCK_H_
#define BCCSKEL_SERVER_STORE_FOLDER_LOCK_H_

#include <chrono>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "server/store/file_io.h"

namespace bccskel::server {

// The right to a data folder: one process has it at a time, until it ends, however it ends. Works
// on file systems where flock() does; do not share the folder over a network.
class FolderLock {
 public:
  // Errors: ALREADY_EXISTS when another process has it.
  static absl::StatusOr<FolderLock> Take(const std::string& folder);

  // The job store to which the folder's files belong; empty before it was told.
  const std::string& store_id() const { return store_id_; }
  absl::Status SetStoreId(const std::string& id);
  // The lock's file was last written then: a sign of life for the next server.
  void Touch(std::chrono::system_clock::time_point now);

 private:
  FolderLock(File file, std::string store_id)
      : file_(std::move(file)), store_id_(std::move(store_id)) {}
  File file_;
  std::string store_id_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_FOLDER_LOCK_H_
