#ifndef BCCSKEL_SERVER_STORE_UPLOAD_FILE_H_
#define BCCSKEL_SERVER_STORE_UPLOAD_FILE_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/digest/sha256.h"
#include "server/store/file_io.h"

namespace bccskel::server {

// The bytes of an unfinished upload, PATH.part, and beside them length and CRC-32C of every chunk,
// PATH.chunks. What was appended survives the process; after a crash of the machine the chunks that
// reached the disk whole are what is left.
// The files are open only while they are used: unfinished uploads may be many and lie about for a
// day. Who removes them meanwhile ends the upload.
// Errors of all: those of SystemError().
// Threads: one at a time.
class UploadFile {
 public:
  // Makes the files, and their folder, or goes on with those that are there: reads them and cuts
  // off what is damaged.
  static absl::StatusOr<std::unique_ptr<UploadFile>> Open(const std::string& path);

  // A new upload with all that is whole in another one, be it that somebody writes that still.
  static absl::StatusOr<std::unique_ptr<UploadFile>> Copy(const std::string& from,
                                                          const std::string& to);
  // Of the chunks, as far as their entries are whole; 0 where there is none.
  static uint64_t SizeOf(const std::string& path);

  uint64_t size() const { return size_; }
  // After an error the upload is as it was before.
  absl::Status Append(std::string_view bytes);
  // Brings all to the disk. Yields the digest of all bytes. Nothing is appended after it.
  absl::StatusOr<Sha256Digest> Seal();

  static absl::Status Remove(const std::string& path);
  static std::string BytesPath(const std::string& path) { return path + ".part"; }
  static std::string ChunksPath(const std::string& path) { return path + ".chunks"; }

 private:
  struct Files {
    File bytes;
    File chunks;
  };
  explicit UploadFile(std::string path) : path_(std::move(path)) {}
  absl::StatusOr<Files> OpenFiles() const;
  absl::Status Recover(Files files);
  // The next chunk's bytes; nothing for one that is not whole.
  absl::StatusOr<std::optional<std::string>> NextChunk(const Files& files) const;
  void Count(std::string_view chunk);

  const std::string path_;
  uint64_t size_ = 0;
  uint64_t chunks_size_ = 0;
  Sha256 sha256_;
  std::optional<Sha256Digest> digest_;  // once sealed
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_UPLOAD_FILE_H_
