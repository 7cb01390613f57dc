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

namespace bccskel::server {

// The system's error `number` while doing `what`.
// RESOURCE_EXHAUSTED when disk or quota are full; UNAVAILABLE when too many files are open;
// NOT_FOUND; else INTERNAL.
absl::Status SystemError(const std::string& what, int number);

// An open file. Errors of all: see SystemError().
// Threads: one at a time.
class File {
 public:
  File() = default;
  ~File();
  File(File&& other) noexcept : path_(std::move(other.path_)), fd_(std::exchange(other.fd_, -1)) {}
  File& operator=(File&& other) noexcept;

  static absl::StatusOr<File> OpenToRead(const std::string& path);
  // Readable and writable by the owner only; made where it does not exist.
  static absl::StatusOr<File> OpenToWrite(const std::string& path);
  // The same, of a file that is there.
  static absl::StatusOr<File> OpenToGoOn(const std::string& path);

  const std::string& path() const { return path_; }
  int fd() const { return fd_; }
  bool is_open() const { return fd_ >= 0; }

  absl::StatusOr<uint64_t> Size() const;
  // Fewer bytes at the end of the file only.
  absl::StatusOr<std::string> ReadAt(uint64_t offset, size_t size) const;
  absl::Status WriteAt(uint64_t offset, std::string_view bytes);
  absl::Status Truncate(uint64_t size);
  // Returns when everything is on the disk.
  absl::Status Sync();

 private:
  File(std::string path, int fd) : path_(std::move(path)), fd_(fd) {}
  static absl::StatusOr<File> Open(const std::string& path, int flags);

  std::string path_;
  int fd_ = -1;
};

// With what is above it; only the owner may enter.
absl::Status MakeFolder(const std::string& path);
absl::Status MakeFolderOf(const std::string& file_path);
// Entries of the folder are on the disk when it returns.
absl::Status SyncFolder(const std::string& path);
absl::Status SyncFolderOf(const std::string& file_path);
// Replaces `to`. The name is on the disk when it returns. Needs: both in the same folder.
absl::Status RenameDurably(const std::string& from, const std::string& to);
// OK also where there is none.
absl::Status RemoveFile(const std::string& path);
// Bytes that can still be written there; 0 where the system does not tell.
uint64_t SpaceOf(const std::string& path);
struct FileFacts {
  std::pair<uint64_t, uint64_t> identity;  // which file it is, whatever its name
  uint64_t size_bytes = 0;
  std::chrono::system_clock::time_point written;  // last
};
absl::StatusOr<FileFacts> FactsOf(const std::string& path);
// All files below, with their paths; none where there is no such folder.
absl::StatusOr<std::vector<std::string>> FilesBelow(const std::string& path);

// Reads a file whose digest is known from front to end.
// Threads: one at a time.
class CheckedFile {
 public:
  // Errors: DATA_LOSS when the file is missing.
  static absl::StatusOr<CheckedFile> Open(const std::string& path, const std::string& digest);

  // The next bytes, at most 1 MiB; none at the end, when all bytes have the digest.
  // Errors: DATA_LOSS for another digest; INTERNAL.
  absl::StatusOr<std::string> Next();

  // Reads on to the end. Errors: as Next().
  absl::Status ReadRest();
  // Rather than read on.
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
