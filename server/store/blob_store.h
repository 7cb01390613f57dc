#ifndef BCCSKEL_SERVER_STORE_BLOB_STORE_H_
#define BCCSKEL_SERVER_STORE_BLOB_STORE_H_

#include <set>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/result_file.h"
#include "server/store/rows.h"

namespace bccskel::server {

// Suffix of files of which nothing has been confirmed; a crash may leave some.
inline constexpr char kUnconfirmed[] = ".new";

// The files of all tenants, each tenant in its own folder:
//
//   tenants/<SHA-256 of the tenant's name>/uploads/<as its row says>.part, .chunks
//                                          blobs/<SHA-256 of the bytes>
//                                          results/<name>
//
// A file in blobs is complete: it gets its name once it is on disk.
// Errors of all: RESOURCE_EXHAUSTED when the disk is full; INTERNAL.
// Threads: safe if each file is used by one thread at a time.
class BlobStore {
 public:
  explicit BlobStore(std::string folder) : folder_(std::move(folder)) {}

  // The path of the upload's bytes for UploadFile. `file` as in UploadRow.
  std::string PathOfUpload(const std::string& tenant, const std::string& file) const;
  std::string PathOf(const UploadRow& row) const { return PathOfUpload(row.tenant, row.file); }
  std::string PathOf(const VolumeRow& row) const { return PathOfBlob(row.tenant, row.blob_digest); }
  std::string PathOfBlob(const std::string& tenant, const std::string& digest) const;
  std::string PathOfResult(const std::string& tenant, const std::string& name) const;
  absl::StatusOr<std::set<std::string>> Files() const;

  // Links the sealed bytes of the upload to their permanent name, in addition to the present one.
  absl::Status PublishBlob(const UploadRow& upload, const std::string& digest) const;
  // Whether the blob exists with this size. Cheap: does not read the bytes.
  bool HasBlob(const std::string& tenant, const std::string& digest, uint64_t size_bytes) const;

  // Creates a result whose name ends in kUnconfirmed until ConfirmResult(), which follows once the
  // tables name it.
  absl::StatusOr<ResultWriter> NewResult(const std::string& tenant, const std::string& name) const;
  // Also confirms the result: readers may find it in the tables before its writer has confirmed it.
  // Errors: DATA_LOSS for a file that is missing or has another digest.
  absl::StatusOr<ResultFile> OpenResult(const std::string& tenant, const std::string& name,
                                        const std::string& digest) const;
  // OK if already confirmed. Not flushed to disk: the next start repeats it.
  absl::Status ConfirmResult(const std::string& tenant, const std::string& name) const;
  absl::Status RemoveResult(const std::string& tenant, const std::string& name) const;

 private:
  std::string PathOf(const std::string& tenant, const char* kind, const std::string& name) const;

  const std::string folder_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_BLOB_STORE_H_
