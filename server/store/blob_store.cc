#include "server/store/blob_store.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "absl/strings/str_cat.h"
#include "core/digest/sha256.h"
#include "core/exec/status_macros.h"
#include "server/store/file_io.h"
#include "server/store/upload_file.h"

namespace bccskel::server {

// Names that callers choose never become file names.
std::string BlobStore::PathOf(const std::string& tenant, const char* kind,
                              const std::string& name) const {
  return absl::StrCat(folder_, "/tenants/", Sha256Of(tenant).Hex(), "/", kind, "/", name);
}

std::string BlobStore::PathOfUpload(const std::string& tenant, const std::string& file) const {
  return PathOf(tenant, "uploads", file);
}

std::string BlobStore::PathOfBlob(const std::string& tenant, const std::string& digest) const {
  return PathOf(tenant, "blobs", digest);
}

std::string BlobStore::PathOfResult(const std::string& tenant, const std::string& name) const {
  return PathOf(tenant, "results", name);
}

absl::Status BlobStore::PublishBlob(const UploadRow& upload, const std::string& digest) const {
  const std::string blob = PathOfBlob(upload.tenant, digest);
  const std::string bytes = UploadFile::BytesPath(PathOf(upload));
  BCCSKEL_RETURN_IF_ERROR(MakeFolderOf(blob));
  // An existing, possibly damaged file of this name is replaced.
  const std::string fresh = blob + kUnconfirmed;
  BCCSKEL_RETURN_IF_ERROR(RemoveFile(fresh));
  if (link(bytes.c_str(), fresh.c_str()) != 0) {
    return SystemError(absl::StrCat("cannot link ", bytes), errno);
  }
  BCCSKEL_RETURN_IF_ERROR(RenameDurably(fresh, blob));
  // rename() does nothing if both are the same file already.
  return RemoveFile(fresh);
}

absl::StatusOr<ResultWriter> BlobStore::NewResult(const std::string& tenant,
                                                  const std::string& name) const {
  const std::string path = PathOfResult(tenant, name) + kUnconfirmed;
  BCCSKEL_RETURN_IF_ERROR(MakeFolderOf(path));
  return ResultWriter::Create(path);
}

absl::Status BlobStore::ConfirmResult(const std::string& tenant, const std::string& name) const {
  const std::string path = PathOfResult(tenant, name);
  const std::string fresh = path + kUnconfirmed;
  if (FactsOf(path).ok()) return absl::OkStatus();
  if (std::rename(fresh.c_str(), path.c_str()) == 0) return absl::OkStatus();
  return SystemError(absl::StrCat("cannot rename ", fresh), errno);
}

absl::StatusOr<ResultFile> BlobStore::OpenResult(const std::string& tenant, const std::string& name,
                                                 const std::string& digest) const {
  ConfirmResult(tenant, name).IgnoreError();  // if this fails, so does opening
  return ResultFile::Open(PathOfResult(tenant, name), digest);
}

absl::Status BlobStore::RemoveResult(const std::string& tenant, const std::string& name) const {
  BCCSKEL_RETURN_IF_ERROR(RemoveFile(PathOfResult(tenant, name) + kUnconfirmed));
  return RemoveFile(PathOfResult(tenant, name));
}

bool BlobStore::HasBlob(const std::string& tenant, const std::string& digest,
                        uint64_t size_bytes) const {
  const auto facts = FactsOf(PathOfBlob(tenant, digest));
  return facts.ok() && facts->size_bytes == size_bytes;
}

absl::StatusOr<std::set<std::string>> BlobStore::Files() const {
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<std::string> files, FilesBelow(folder_ + "/tenants"));
  return std::set<std::string>(files.begin(), files.end());
}

}  // namespace bccskel::server
