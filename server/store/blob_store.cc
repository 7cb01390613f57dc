#include "server/store/blob_store.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "absl/strings/str_cat.h"
#include "core/digest/sha256.h"
#include "core/exec/status_macros.h"
#include "server/store/file_io.h"

namespace bccskel::server {
namespace {

// Names that callers choose never become file names.
std::string SafeName(const std::string& name) { return Sha256Of(name).Hex(); }

}  // namespace

std::string BlobStore::FolderOf(const std::string& tenant, const char* kind) const {
  return absl::StrCat(folder_, "/tenants/", SafeName(tenant), "/", kind);
}

std::string BlobStore::UploadPath(const std::string& tenant, const std::string& upload,
                                  const std::string& file) const {
  return absl::StrCat(FolderOf(tenant, "uploads"), "/", file.empty() ? SafeName(upload) : file);
}

std::string BlobStore::PathOfBlob(const std::string& tenant, const std::string& digest) const {
  return absl::StrCat(FolderOf(tenant, "blobs"), "/", digest);
}

std::string BlobStore::PathOfResult(const std::string& tenant, const std::string& name) const {
  return absl::StrCat(FolderOf(tenant, "results"), "/", name);
}

std::set<std::string> BlobStore::PathsOfUpload(const std::string& tenant, const std::string& upload,
                                               const std::string& file) const {
  const std::string path = UploadPath(tenant, upload, file);
  return {UploadFile::BytesPath(path), UploadFile::ChunksPath(path)};
}

absl::StatusOr<std::unique_ptr<UploadFile>> BlobStore::OpenUpload(const std::string& tenant,
                                                                  const std::string& upload,
                                                                  const std::string& file) const {
  BCCSKEL_RETURN_IF_ERROR(MakeFolder(FolderOf(tenant, "uploads")));
  return UploadFile::Open(UploadPath(tenant, upload, file));
}

absl::StatusOr<std::unique_ptr<UploadFile>> BlobStore::CopyUpload(const std::string& tenant,
                                                                  const std::string& upload,
                                                                  const std::string& from,
                                                                  const std::string& to) const {
  return UploadFile::Copy(UploadPath(tenant, upload, from), UploadPath(tenant, upload, to));
}

uint64_t BlobStore::SizeOfUpload(const std::string& tenant, const std::string& upload,
                                 const std::string& file) const {
  return UploadFile::SizeOf(UploadPath(tenant, upload, file));
}

absl::StatusOr<FileFacts> BlobStore::FactsOfUpload(const std::string& tenant,
                                                   const std::string& upload,
                                                   const std::string& file) const {
  return FactsOf(UploadFile::BytesPath(UploadPath(tenant, upload, file)));
}

absl::Status BlobStore::RemoveUpload(const std::string& tenant, const std::string& upload,
                                     const std::string& file) const {
  return UploadFile::Remove(UploadPath(tenant, upload, file));
}

absl::Status BlobStore::PublishBlob(const std::string& tenant, const std::string& upload,
                                    const std::string& digest, const std::string& file) const {
  BCCSKEL_RETURN_IF_ERROR(MakeFolder(FolderOf(tenant, "blobs")));
  const std::string blob = PathOfBlob(tenant, digest);
  const std::string bytes = UploadFile::BytesPath(UploadPath(tenant, upload, file));
  // A file of this name may be there and damaged: it is replaced.
  const std::string fresh = blob + kUnconfirmed;
  BCCSKEL_RETURN_IF_ERROR(RemoveFile(fresh));
  if (link(bytes.c_str(), fresh.c_str()) != 0) {
    return SystemError(absl::StrCat("cannot link ", bytes), errno);
  }
  BCCSKEL_RETURN_IF_ERROR(RenameDurably(fresh, blob));
  // rename() does nothing where both are the same file already.
  return RemoveFile(fresh);
}

absl::StatusOr<CheckedFile> BlobStore::OpenBlob(const std::string& tenant,
                                                const std::string& digest) const {
  return CheckedFile::Open(PathOfBlob(tenant, digest), digest);
}

absl::Status BlobStore::RemoveBlob(const std::string& tenant, const std::string& digest) const {
  return RemoveFile(PathOfBlob(tenant, digest));
}

absl::StatusOr<ResultWriter> BlobStore::NewResult(const std::string& tenant,
                                                  const std::string& name) const {
  BCCSKEL_RETURN_IF_ERROR(MakeFolder(FolderOf(tenant, "results")));
  return ResultWriter::Create(PathOfResult(tenant, name) + kUnconfirmed);
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
  ConfirmResult(tenant, name).IgnoreError();  // if that fails, so does this
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
