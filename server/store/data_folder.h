#ifndef BCCSKEL_SERVER_STORE_DATA_FOLDER_H_
#define BCCSKEL_SERVER_STORE_DATA_FOLDER_H_

#include <chrono>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "server/store/file_io.h"

namespace bccskel::server {

// The right to a data folder: one process has it at a time, or several that share it, until they
// end, however they end. Works on file systems where flock() does. Those who share need it only to
// keep out who wants the folder alone: they do without it where there is no flock().
class FolderLock {
 public:
  enum class With { kNobody, kOthers };
  // Errors: ALREADY_EXISTS when another process has it, and does not share it as this one.
  static absl::StatusOr<FolderLock> Take(const std::string& folder, With with = With::kNobody);

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

// Space that is held back on a disk, so that what makes room there, or ends a job, can be written
// when nothing else can.
// Threads: one at a time.
class DiskReserve {
 public:
  // Holds nothing yet, and gives free what a process before this one held.
  explicit DiskReserve(std::string path) : path_(std::move(path)) { Release(); }

  // Takes the space; later, where there is too little now.
  void Hold();
  // Gives it to whoever writes next.
  void Release();
  bool held() const { return held_; }

 private:
  const std::string path_;
  bool held_ = false;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_DATA_FOLDER_H_
