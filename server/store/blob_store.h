#ifndef BCCSKEL_SERVER_STORE_BLOB_STORE_H_
#define BCCSKEL_SERVER_STORE_BLOB_STORE_H_

#include <memory>
#include <set>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/file_io.h"
#include "server/store/result_file.h"
#include "server/store/upload_file.h"

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

  // `file`: of the upload's row; empty for one named after the upload.
  absl::StatusOr<std::unique_ptr<UploadFile>> OpenUpload(const std::string& tenant,
                                                         const std::string& upload,
                                                         const std::string& file = {}) const;
  // Copies what is whole in `from` to `to`, which is new: who still writes the one does not disturb
  // the other.
  absl::StatusOr<std::unique_ptr<UploadFile>> CopyUpload(const std::string& tenant,
                                                         const std::string& upload,
                                                         const std::string& from,
                                                         const std::string& to) const;
  // As far as its chunks say; their bytes are not looked at.
  uint64_t SizeOfUpload(const std::string& tenant, const std::string& upload,
                        const std::string& file) const;
  // When its bytes were last written. Errors: NOT_FOUND.
  absl::StatusOr<FileFacts> FactsOfUpload(const std::string& tenant, const std::string& upload,
                                          const std::string& file) const;
  absl::Status RemoveUpload(const std::string& tenant, const std::string& upload,
                            const std::string& file = {}) const;
  // Gives the sealed bytes of the upload their lasting name, besides the one that they have.
  absl::Status PublishBlob(const std::string& tenant, const std::string& upload,
                           const std::string& digest, const std::string& file = {}) const;
  absl::StatusOr<CheckedFile> OpenBlob(const std::string& tenant, const std::string& digest) const;
  absl::Status RemoveBlob(const std::string& tenant, const std::string& digest) const;

  // Its name ends in kUnconfirmed until ConfirmResult(), which comes when the tables have it.
  absl::StatusOr<ResultWriter> NewResult(const std::string& tenant, const std::string& name) const;
  // Confirms it, too: readers may learn of it from the tables before their writer comes to that.
  // Errors: DATA_LOSS for a file that is missing or has another digest.
  absl::StatusOr<ResultFile> OpenResult(const std::string& tenant, const std::string& name,
                                        const std::string& digest) const;
  // OK also where it was done. Not flushed: the next start does it again.
  absl::Status ConfirmResult(const std::string& tenant, const std::string& name) const;
  absl::Status RemoveResult(const std::string& tenant, const std::string& name) const;

  // Whether it is there with this size. Cheap: the bytes are not looked at.
  bool HasBlob(const std::string& tenant, const std::string& digest, uint64_t size_bytes) const;

  // The paths of what there should be, and of what there is.
  std::set<std::string> PathsOfUpload(const std::string& tenant, const std::string& upload,
                                      const std::string& file = {}) const;
  std::string PathOfBlob(const std::string& tenant, const std::string& digest) const;
  std::string PathOfResult(const std::string& tenant, const std::string& name) const;
  absl::StatusOr<std::set<std::string>> Files() const;

 private:
  std::string FolderOf(const std::string& tenant, const char* kind) const;
  std::string UploadPath(const std::string& tenant, const std::string& upload,
                         const std::string& file) const;

  const std::string folder_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_BLOB_STORE_H_
