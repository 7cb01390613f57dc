#ifndef BCCSKEL_SERVER_STORE_FILE_IO_H_
#define BCCSKEL_SERVER_STORE_FILE_IO_H_

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/digest/sha256.h"
#include "core/exec/descriptor.h"

namespace bccskel::server {

// Converts the system's error `number` while doing `what`: RESOURCE_EXHAUSTED when disk or quota
// are full; UNAVAILABLE when too many files are open; NOT_FOUND; else INTERNAL.
absl::Status SystemError(const std::string& what, int number);
// Whether SystemError() made the status because a file or folder is missing.
bool IsMissingFile(const absl::Status& status);

// An open file. Errors of all: see SystemError().
// Threads: one at a time.
class File {
 public:
  File() = default;

  static absl::StatusOr<File> OpenToRead(const std::string& path);
  // Creates the file if missing, accessible by the owner only.
  static absl::StatusOr<File> OpenToWrite(const std::string& path);
  // The same, for an existing file.
  static absl::StatusOr<File> OpenToGoOn(const std::string& path);

  const std::string& path() const { return path_; }
  int fd() const { return descriptor_.get(); }
  bool is_open() const { return descriptor_.is_open(); }

  absl::StatusOr<uint64_t> Size() const;
  // Yields fewer bytes only at the end of the file, and allocates no more than there are.
  absl::StatusOr<std::string> ReadAt(uint64_t offset, size_t size) const;
  absl::Status WriteAt(uint64_t offset, std::string_view bytes);
  absl::Status Truncate(uint64_t size);
  // Returns when all data is on disk.
  absl::Status Sync();

 private:
  File(std::string path, exec::Descriptor descriptor)
      : path_(std::move(path)), descriptor_(std::move(descriptor)) {}
  static absl::StatusOr<File> Open(const std::string& path, int flags);

  std::string path_;
  exec::Descriptor descriptor_;
};

// Creates the folder and its parents, accessible by the owner only.
absl::Status MakeFolder(const std::string& path);
absl::Status MakeFolderOf(const std::string& file_path);
// Returns when the folder's entries are on disk.
absl::Status SyncFolder(const std::string& path);
absl::Status SyncFolderOf(const std::string& file_path);
// Replaces `to`. Returns when the name is on disk. Needs: both in the same folder.
absl::Status RenameDurably(const std::string& from, const std::string& to);
// OK if there is no such file.
absl::Status RemoveFile(const std::string& path);
// Free bytes of the file system; 0 if the system does not report them.
uint64_t SpaceOf(const std::string& path);
struct FileFacts {
  std::pair<uint64_t, uint64_t> identity;  // identifies the file regardless of its name
  uint64_t size_bytes = 0;
  std::chrono::system_clock::time_point written;  // last
};
absl::StatusOr<FileFacts> FactsOf(const std::string& path);
// The paths of all files below the folder; none if it does not exist.
absl::StatusOr<std::vector<std::string>> FilesBelow(const std::string& path);

// Reads a file front to end and checks its digest.
// Threads: one at a time.
class CheckedFile {
 public:
  // Errors: DATA_LOSS when the file is missing.
  static absl::StatusOr<CheckedFile> Open(const std::string& path, const std::string& digest);

  // The next bytes, at most 1 MiB; none at the end if the digest matches.
  // Errors: DATA_LOSS for another digest; INTERNAL.
  absl::StatusOr<std::string> Next();

  // Reads to the end. Errors: as Next().
  absl::Status ReadRest();
  // Gives up the file instead of reading on.
  File TakeFile() && { return std::move(file_); }

 private:
  CheckedFile(File file, std::string digest) : file_(std::move(file)), digest_(std::move(digest)) {}

  File file_;
  std::string digest_;
  Sha256 sha256_;
  uint64_t offset_ = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_FILE_IO_H_
