#include "server/store/result_file.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/store/file_io.h"
#include "server/store/stored_bytes.h"

namespace bccskel::server {
namespace {

constexpr std::string_view kMark("bccres1\n", 8);
constexpr size_t kHeadBytes = sizeof(uint8_t) + sizeof(uint32_t);
constexpr size_t kFooterEnd = 2 * sizeof(uint64_t);

}  // namespace

absl::StatusOr<ResultWriter> ResultWriter::Create(const std::string& path) {
  BCCSKEL_ASSIGN_OR_RETURN(File file, File::OpenToWrite(path));
  BCCSKEL_RETURN_IF_ERROR(file.Truncate(0));
  ResultWriter writer(std::move(file));
  BCCSKEL_RETURN_IF_ERROR(writer.Write(kMark));
  return writer;
}

absl::Status ResultWriter::Write(std::string_view bytes) {
  BCCSKEL_RETURN_IF_ERROR(file_.WriteAt(bytes_, bytes));
  sha256_.Add(bytes);
  bytes_ += bytes.size();
  return absl::OkStatus();
}

absl::Status ResultWriter::Add(uint8_t kind, std::string_view bytes) {
  std::string head;
  AppendNumber(kind, head);
  AppendNumber(static_cast<uint32_t>(bytes.size()), head);
  positions_.push_back(bytes_);
  BCCSKEL_RETURN_IF_ERROR(Write(head));
  return Write(bytes);
}

absl::StatusOr<Sha256Digest> ResultWriter::Finish() {
  std::string footer;
  for (const uint64_t position : positions_) AppendNumber(position, footer);
  AppendNumber(bytes_, footer);
  AppendNumber(uint64_t{positions_.size()}, footer);
  BCCSKEL_RETURN_IF_ERROR(Write(footer));
  BCCSKEL_RETURN_IF_ERROR(file_.Sync());
  BCCSKEL_RETURN_IF_ERROR(SyncFolderOf(file_.path()));
  return sha256_.Finish();
}

absl::StatusOr<ResultFile> ResultFile::Open(const std::string& path, const std::string& digest) {
  BCCSKEL_ASSIGN_OR_RETURN(CheckedFile checked, CheckedFile::Open(path, digest));
  BCCSKEL_RETURN_IF_ERROR(checked.ReadRest());
  ResultFile result(std::move(checked).TakeFile());
  BCCSKEL_RETURN_IF_ERROR(result.ReadPositions());
  return result;
}

absl::Status ResultFile::Damaged() const {
  return absl::DataLossError(absl::StrCat(file_.path(), " is not a result of this version"));
}

absl::Status ResultFile::ReadPositions() {
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t size, file_.Size());
  if (size < kMark.size() + kFooterEnd) return Damaged();
  BCCSKEL_ASSIGN_OR_RETURN(const std::string mark, file_.ReadAt(0, kMark.size()));
  BCCSKEL_ASSIGN_OR_RETURN(const std::string end, file_.ReadAt(size - kFooterEnd, kFooterEnd));
  const auto start = NumberAt<uint64_t>(end, 0);
  const auto count = NumberAt<uint64_t>(end, sizeof(uint64_t));
  if (mark != kMark || start > size - kFooterEnd ||
      count != (size - kFooterEnd - start) / sizeof(uint64_t)) {
    return Damaged();
  }
  BCCSKEL_ASSIGN_OR_RETURN(const std::string positions,
                           file_.ReadAt(start, count * sizeof(uint64_t)));
  for (uint64_t n = 0; n < count; ++n) {
    positions_.push_back(NumberAt<uint64_t>(positions, n * sizeof(uint64_t)));
  }
  return absl::OkStatus();
}

absl::StatusOr<ResultFile::Record> ResultFile::Read(uint64_t record) const {
  if (record >= positions_.size()) {
    return absl::OutOfRangeError(
        absl::StrCat("record ", record, " of a result with ", positions_.size()));
  }
  const uint64_t position = positions_[record];
  BCCSKEL_ASSIGN_OR_RETURN(const std::string head, file_.ReadAt(position, kHeadBytes));
  if (head.size() < kHeadBytes) return Damaged();
  const size_t length = NumberAt<uint32_t>(head, 1);
  Record read = {.kind = NumberAt<uint8_t>(head, 0), .bytes = {}};
  BCCSKEL_ASSIGN_OR_RETURN(read.bytes, file_.ReadAt(position + kHeadBytes, length));
  if (read.bytes.size() < length) return Damaged();
  return read;
}

}  // namespace bccskel::server
