#include "server/store/checked_file.h"

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"

namespace bccskel::server {
namespace {

constexpr size_t kReadBytes = size_t{1} << 20;

}  // namespace

absl::StatusOr<CheckedFile> CheckedFile::Open(const std::string& path, const std::string& digest) {
  absl::StatusOr<File> file = File::OpenToRead(path);
  if (file.ok()) return CheckedFile(*std::move(file), digest);
  if (!absl::IsNotFound(file.status())) return file.status();
  return absl::DataLossError(absl::StrCat("the stored file with SHA-256 ", digest, " is missing"));
}

absl::StatusOr<std::string> CheckedFile::Next() {
  BCCSKEL_ASSIGN_OR_RETURN(std::string bytes, file_.ReadAt(offset_, kReadBytes));
  offset_ += bytes.size();
  sha256_.Add(bytes);
  if (!bytes.empty()) return bytes;
  const std::string found = sha256_.Finish().Hex();
  if (found == digest_) return bytes;
  return absl::DataLossError(absl::StrCat("a stored file of ", offset_,
                                          " bytes is damaged: its SHA-256 is ", found,
                                          ", expected was ", digest_));
}

}  // namespace bccskel::server
