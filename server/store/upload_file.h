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

// The bytes of an unfinished upload, PATH.part, and the length and CRC-32C of every chunk,
// PATH.chunks. Appended chunks survive the process; after a crash of the machine, those that
// reached the disk whole remain.
// The files are open only while in use, because there may be many unfinished uploads, each for a
// day. Removing the files ends the upload.
// Errors of all: those of SystemError().
// Threads: one at a time.
class UploadFile {
 public:
  // Creates the files and their folder, or opens existing ones: reads them and truncates what is
  // damaged.
  static absl::StatusOr<std::unique_ptr<UploadFile>> Open(const std::string& path);

  // A new upload with the intact chunks of another one, which may still be written.
  static absl::StatusOr<std::unique_ptr<UploadFile>> Copy(const std::string& from,
                                                          const std::string& to);
  // Total size of the chunks with intact entries; 0 if there is no upload.
  static uint64_t SizeOf(const std::string& path);

  uint64_t size() const { return size_; }
  // An error leaves the upload unchanged.
  absl::Status Append(std::string_view bytes);
  // Brings everything to disk. Yields the digest of all bytes. Nothing may be appended afterwards.
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
  // The next chunk's bytes; nullopt if it is damaged.
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
