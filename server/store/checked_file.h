#ifndef BCCSKEL_SERVER_STORE_CHECKED_FILE_H_
#define BCCSKEL_SERVER_STORE_CHECKED_FILE_H_

#include <cstdint>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "core/digest/sha256.h"
#include "server/store/file_io.h"

namespace bccskel::server {

// Reads a file whose digest is known from front to end.
// Threads: one at a time.
class CheckedFile {
 public:
  // Errors: DATA_LOSS when the file is missing.
  static absl::StatusOr<CheckedFile> Open(const std::string& path, const std::string& digest);

  // The next bytes, at most 1 MiB; none at the end, when all bytes have the digest.
  // Errors: DATA_LOSS for another digest; INTERNAL.
  absl::StatusOr<std::string> Next();

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

#endif  // BCCSKEL_SERVER_STORE_CHECKED_FILE_H_
