#ifndef BCCSKEL_SERVER_STORE_DATA_FOLDER_H_
#define BCCSKEL_SERVER_STORE_DATA_FOLDER_H_

#include <chrono>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "server/store/file_io.h"

namespace bccskel::server {

// A lock on a data folder: held by one process, or by several that share it, until they end,
// however they end. It locks the file `lock`, which names the folder's job store, and the folder
// itself, because somebody may remove that file. Works on file systems with flock(). Processes that
// share need the lock only to keep out a sole owner: they do without it where there is no flock().
class FolderLock {
 public:
  enum class With { kNobody, kOthers };
  // Errors: ALREADY_EXISTS when another process has the folder, unless both share it.
  static absl::StatusOr<FolderLock> Take(const std::string& path, With with = With::kNobody);

  // The job store that the folder's files belong to; empty before SetStoreId().
  const std::string& store_id() const { return store_id_; }
  absl::Status SetStoreId(const std::string& id);
  // Sets the modification time of the lock's file: a sign of life for the next server.
  void Touch(std::chrono::system_clock::time_point now);

 private:
  FolderLock(File folder, File file, std::string store_id)
      : folder_(std::move(folder)), file_(std::move(file)), store_id_(std::move(store_id)) {}
  File folder_, file_;
  std::string store_id_;
};

// Reserved disk space, so that operations that free space or end a job can be written when nothing
// else can.
// Threads: one at a time.
class DiskReserve {
 public:
  // Holds nothing yet, and releases what an earlier process held.
  explicit DiskReserve(std::string path) : path_(std::move(path)) { Release(); }

  // Reserves the space, or retries later if there is too little now.
  void Hold();
  // Releases the space for the next write.
  void Release();
  bool held() const { return held_; }

 private:
  const std::string path_;
  bool held_ = false;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_DATA_FOLDER_H_
