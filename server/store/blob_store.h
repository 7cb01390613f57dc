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

// The end of the names of files that nothing has been confirmed of: a crash may leave such.
inline constexpr char kUnconfirmed[] = ".new";

// The files of all tenants, each in a folder of its own:
//
//   tenants/<SHA-256 of the tenant's name>/uploads/<as its row says>.part, .chunks
//                                          blobs/<SHA-256 of the bytes>
//                                          results/<name>
//
// A file in blobs is whole: it gets its name when it is on the disk.
// Errors of all: RESOURCE_EXHAUSTED when the disk is full; INTERNAL.
// Threads: safe, as long as each file is used by one at a time.
class BlobStore {
 public:
  explicit BlobStore(std::string folder) : folder_(std::move(folder)) {}

  // Where the upload's bytes are, as UploadFile takes it. `file`: of its row; empty for one named
  // after the upload.
  std::string PathOfUpload(const std::string& tenant, const std::string& upload,
                           const std::string& file = {}) const;
  std::string PathOf(const UploadRow& row) const;
  std::string PathOf(const VolumeRow& row) const { return PathOfBlob(row.tenant, row.blob_digest); }
  std::string PathOfBlob(const std::string& tenant, const std::string& digest) const;
  std::string PathOfResult(const std::string& tenant, const std::string& name) const;
  absl::StatusOr<std::set<std::string>> Files() const;

  // Gives the sealed bytes of the upload their lasting name, besides the one that they have.
  absl::Status PublishBlob(const UploadRow& upload, const std::string& digest) const;
  // Whether it is there with this size. Cheap: the bytes are not looked at.
  bool HasBlob(const std::string& tenant, const std::string& digest, uint64_t size_bytes) const;

  // Its name ends in kUnconfirmed until ConfirmResult(), which comes when the tables have it.
  absl::StatusOr<ResultWriter> NewResult(const std::string& tenant, const std::string& name) const;
  // Confirms it, too: readers may learn of it from the tables before their writer comes to that.
  // Errors: DATA_LOSS for a file that is missing or has another digest.
  absl::StatusOr<ResultFile> OpenResult(const std::string& tenant, const std::string& name,
                                        const std::string& digest) const;
  // OK also where it was done. Not flushed: the next start does it again.
  absl::Status ConfirmResult(const std::string& tenant, const std::string& name) const;
  absl::Status RemoveResult(const std::string& tenant, const std::string& name) const;

 private:
  std::string PathOf(const std::string& tenant, const char* kind, const std::string& name) const;

  const std::string folder_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_BLOB_STORE_H_
