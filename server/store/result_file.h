#ifndef BCCSKEL_SERVER_STORE_RESULT_FILE_H_
#define BCCSKEL_SERVER_STORE_RESULT_FILE_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/digest/sha256.h"
#include "server/store/file_io.h"

namespace bccskel::server {

// A file of records that can be read from any record on:
//   8 bytes of magic; records (kind: 1 byte, length: 4, bytes); positions of the records: 8 each;
//   position of those: 8; number of records: 8. Numbers are little-endian.
// Threads: one at a time.
class ResultWriter {
 public:
  // Errors of all: RESOURCE_EXHAUSTED when the disk is full; INTERNAL.
  static absl::StatusOr<ResultWriter> Create(const std::string& path);

  absl::Status Add(uint8_t kind, std::string_view bytes);
  // Brings everything, including the file's name, to disk. Yields the digest of the file. Nothing
  // may be added afterwards.
  absl::StatusOr<Sha256Digest> Finish();

  uint64_t bytes() const { return bytes_; }
  uint64_t records() const { return positions_.size(); }

 private:
  explicit ResultWriter(File file) : file_(std::move(file)) {}
  absl::Status Write(std::string_view bytes);

  File file_;
  Sha256 sha256_;
  uint64_t bytes_ = 0;
  std::vector<uint64_t> positions_;
};

// Threads: one at a time.
class ResultFile {
 public:
  // Reads the file once to check it. Errors: DATA_LOSS for a file that is missing or has another
  // digest.
  static absl::StatusOr<ResultFile> Open(const std::string& path, const std::string& digest);

  uint64_t records() const { return positions_.size(); }
  struct Record {
    uint8_t kind = 0;
    std::string bytes;
  };
  // Errors: OUT_OF_RANGE; DATA_LOSS; INTERNAL.
  absl::StatusOr<Record> Read(uint64_t record) const;

 private:
  explicit ResultFile(File file) : file_(std::move(file)) {}
  absl::Status ReadPositions();
  absl::Status Damaged() const;

  File file_;
  std::vector<uint64_t> positions_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_RESULT_FILE_H_
