#include "server/store/upload_file.h"

#include <utility>

#include "core/digest/crc32c.h"
#include "core/exec/status_macros.h"
#include "server/store/stored_bytes.h"

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

bool IsWhole(const std::string& entry) {
  if (entry.size() < kEntryBytes) return false;
  return NumberAt<uint32_t>(entry, kCheckedBytes) ==
         Crc32c(std::string_view(entry).substr(0, kCheckedBytes));
}

}  // namespace

absl::StatusOr<std::unique_ptr<UploadFile>> UploadFile::Open(const std::string& path) {
  BCCSKEL_RETURN_IF_ERROR(MakeFolderOf(path));
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

absl::StatusOr<std::unique_ptr<UploadFile>> UploadFile::Copy(const std::string& from,
                                                             const std::string& to) {
  BCCSKEL_ASSIGN_OR_RETURN(File bytes, File::OpenToRead(BytesPath(from)));
  BCCSKEL_ASSIGN_OR_RETURN(File chunks, File::OpenToRead(ChunksPath(from)));
  const Files files = {std::move(bytes), std::move(chunks)};
  UploadFile source(from);
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<UploadFile> copy, Open(to));
  while (true) {
    BCCSKEL_ASSIGN_OR_RETURN(const auto chunk, source.NextChunk(files));
    if (!chunk.has_value()) return copy;
    source.Count(*chunk);
    BCCSKEL_RETURN_IF_ERROR(copy->Append(*chunk));
  }
}

uint64_t UploadFile::SizeOf(const std::string& path) {
  const auto chunks = File::OpenToRead(ChunksPath(path));
  uint64_t size = 0;
  for (uint64_t at = 0; chunks.ok(); at += kEntryBytes) {
    const auto entry = chunks->ReadAt(at, kEntryBytes);
    if (!entry.ok() || !IsWhole(*entry)) break;
    size += NumberAt<uint32_t>(*entry, 0);
  }
  return size;
}

absl::Status UploadFile::Recover(Files files) {
  while (true) {
    BCCSKEL_ASSIGN_OR_RETURN(const auto chunk, NextChunk(files));
    if (!chunk.has_value()) break;
    Count(*chunk);
  }
  BCCSKEL_RETURN_IF_ERROR(files.bytes.Truncate(size_));
  return files.chunks.Truncate(chunks_size_);
}

absl::StatusOr<std::optional<std::string>> UploadFile::NextChunk(const Files& files) const {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string entry, files.chunks.ReadAt(chunks_size_, kEntryBytes));
  if (!IsWhole(entry)) return std::nullopt;
  const size_t length = NumberAt<uint32_t>(entry, 0);
  BCCSKEL_ASSIGN_OR_RETURN(std::string chunk, files.bytes.ReadAt(size_, length));
  if (chunk.size() < length || Crc32c(chunk) != NumberAt<uint32_t>(entry, sizeof(uint32_t))) {
    return std::nullopt;
  }
  return std::optional(std::move(chunk));
}

void UploadFile::Count(std::string_view chunk) {
  sha256_.Add(chunk);
  size_ += chunk.size();
  chunks_size_ += kEntryBytes;
}

absl::Status UploadFile::Append(std::string_view bytes) {
  BCCSKEL_ASSIGN_OR_RETURN(Files files, OpenFiles());
  absl::Status status = files.bytes.WriteAt(size_, bytes);
  if (status.ok()) status = files.chunks.WriteAt(chunks_size_, EntryOf(bytes));
  if (!status.ok()) {
    // Frees space now if the disk is full; Recover() would do it, too.
    files.bytes.Truncate(size_).IgnoreError();
    files.chunks.Truncate(chunks_size_).IgnoreError();
    return status;
  }
  Count(bytes);
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
