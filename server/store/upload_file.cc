#include "server/store/upload_file.h"

#include <utility>

#include "core/digest/crc32c.h"
#include "core/exec/status_macros.h"
#include "server/store/little_endian.h"

namespace bccskel::server {
namespace {

// A chunk's entry: its length, its CRC, and the CRC of these two.
constexpr size_t kCheckedBytes = sizeof(uint32_t) + sizeof(uint32_t);
constexpr size_t kEntryBytes = kCheckedBytes + sizeof(uint32_t);

std::string EntryOf(std::string_view bytes) {
  std::string entry;
  AppendNumber(static_cast<uint32_t>(bytes.size()), entry);
  AppendNumber(Crc32c(bytes), entry);
  AppendNumber(Crc32c(entry), entry);
  return entry;
}

}  // namespace

absl::StatusOr<std::unique_ptr<UploadFile>> UploadFile::Open(const std::string& path) {
  BCCSKEL_ASSIGN_OR_RETURN(File bytes, File::OpenToWrite(BytesPath(path)));
  BCCSKEL_ASSIGN_OR_RETURN(File chunks, File::OpenToWrite(ChunksPath(path)));
  std::unique_ptr<UploadFile> upload(new UploadFile(path));
  BCCSKEL_RETURN_IF_ERROR(upload->Recover({std::move(bytes), std::move(chunks)}));
  return upload;
}

absl::StatusOr<UploadFile::Files> UploadFile::OpenFiles() const {
  BCCSKEL_ASSIGN_OR_RETURN(File bytes, File::OpenToGoOn(BytesPath(path_)));
  BCCSKEL_ASSIGN_OR_RETURN(File chunks, File::OpenToGoOn(ChunksPath(path_)));
  return Files{std::move(bytes), std::move(chunks)};
}

absl::Status UploadFile::Recover(Files files) {
  bool whole = true;
  while (whole) {
    BCCSKEL_ASSIGN_OR_RETURN(whole, RecoverChunk(files));
  }
  BCCSKEL_RETURN_IF_ERROR(files.bytes.Truncate(size_));
  return files.chunks.Truncate(chunks_size_);
}

absl::StatusOr<bool> UploadFile::RecoverChunk(const Files& files) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string entry, files.chunks.ReadAt(chunks_size_, kEntryBytes));
  if (entry.size() < kEntryBytes) return false;
  const std::string_view checked = std::string_view(entry).substr(0, kCheckedBytes);
  if (NumberAt<uint32_t>(entry, kCheckedBytes) != Crc32c(checked)) return false;
  const size_t length = NumberAt<uint32_t>(entry, 0);
  BCCSKEL_ASSIGN_OR_RETURN(const std::string chunk, files.bytes.ReadAt(size_, length));
  if (chunk.size() < length || Crc32c(chunk) != NumberAt<uint32_t>(entry, sizeof(uint32_t))) {
    return false;
  }
  sha256_.Add(chunk);
  size_ += length;
  chunks_size_ += kEntryBytes;
  return true;
}

absl::Status UploadFile::Append(std::string_view bytes) {
  BCCSKEL_ASSIGN_OR_RETURN(Files files, OpenFiles());
  absl::Status status = files.bytes.WriteAt(size_, bytes);
  if (status.ok()) status = files.chunks.WriteAt(chunks_size_, EntryOf(bytes));
  if (!status.ok()) {
    // Best done now, on a full disk; Recover() would do it, too.
    files.bytes.Truncate(size_).IgnoreError();
    files.chunks.Truncate(chunks_size_).IgnoreError();
    return status;
  }
  sha256_.Add(bytes);
  size_ += bytes.size();
  chunks_size_ += kEntryBytes;
  return absl::OkStatus();
}

absl::StatusOr<Sha256Digest> UploadFile::Seal() {
  BCCSKEL_ASSIGN_OR_RETURN(Files files, OpenFiles());
  BCCSKEL_RETURN_IF_ERROR(files.bytes.Sync());
  if (!digest_.has_value()) digest_ = sha256_.Finish();
  return *digest_;
}

absl::Status UploadFile::Remove(const std::string& path) {
  BCCSKEL_RETURN_IF_ERROR(RemoveFile(BytesPath(path)));
  return RemoveFile(ChunksPath(path));
}

}  // namespace bccskel::server
