#include "server/durable/stored_result.h"

#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/errors/call_error.h"
#include "server/jobs/names.h"

namespace bccskel::server {
namespace {

// Takes from the quota what the writer adds.
class CountedWriter {
 public:
  CountedWriter(ResultWriter writer, const std::string& tenant, DiskQuota& quota)
      : writer_(std::move(writer)), tenant_(tenant), quota_(quota) {}
  ~CountedWriter() { quota_.GiveBack(tenant_, taken_); }

  absl::Status Add(const ResultRecord& record) {
    BCCSKEL_RETURN_IF_ERROR(Take(record.bytes.size()));
    if (record.kind == ResultRecord::Kind::kSummary) summary_ = record.bytes;
    return writer_.Add(static_cast<uint8_t>(record.kind), record.bytes);
  }

  // The bytes stay counted.
  absl::StatusOr<ResultRow> Finish() {
    BCCSKEL_ASSIGN_OR_RETURN(const Sha256Digest digest, writer_.Finish());
    const uint64_t bytes = writer_.bytes();
    quota_.Count(tenant_, bytes);
    return ResultRow{.tenant = tenant_,
                     .key = {},
                     .file = {},
                     .file_digest = digest.Hex(),
                     .bytes = bytes,
                     .records = writer_.records(),
                     .summary = summary_};
  }

 private:
  absl::Status Take(uint64_t bytes) {
    BCCSKEL_RETURN_IF_ERROR(quota_.Take(tenant_, bytes));
    taken_ += bytes;
    return absl::OkStatus();
  }

  ResultWriter writer_;
  const std::string tenant_;
  DiskQuota& quota_;
  uint64_t taken_ = 0;
  std::string summary_;
};

absl::StatusOr<ResultRow> WriteFile(const JobResult& result, const Run& run,
                                    const std::string& file, const JobCodec& codec,
                                    const BlobStore& blobs, DiskQuota& quota) {
  BCCSKEL_ASSIGN_OR_RETURN(ResultWriter opened, blobs.NewResult(run.tenant(), file));
  CountedWriter writer(std::move(opened), run.tenant(), quota);
  const auto add = [&](const ResultRecord& record) {
    return run.cancelled() ? absl::CancelledError("the run was cancelled") : writer.Add(record);
  };
  BCCSKEL_RETURN_IF_ERROR(codec.WriteResult(result, add));
  BCCSKEL_ASSIGN_OR_RETURN(ResultRow row, writer.Finish());
  row.file = file;
  return row;
}

}  // namespace

absl::StatusOr<ResultRow> WriteResult(const JobResult& result, const Run& run,
                                      const JobCodec& codec, const BlobStore& blobs,
                                      DiskQuota& quota) {
  const std::string file = RandomId();
  absl::StatusOr<ResultRow> row = WriteFile(result, run, file, codec, blobs, quota);
  if (!row.ok()) blobs.RemoveResult(run.tenant(), file).IgnoreError();
  return row;
}

void RemoveResult(const ResultRow& row, const BlobStore& blobs, DiskQuota& quota) {
  // A file that cannot be removed now is swept at the next start.
  blobs.RemoveResult(row.tenant, row.file).IgnoreError();
  quota.GiveBack(row.tenant, row.bytes);
}

absl::StatusOr<std::shared_ptr<ResultReader>> ResultReader::Open(const ResultRow& row,
                                                                 uint64_t first_record,
                                                                 const BlobStore& blobs,
                                                                 TaskThreads& threads) {
  if (first_record > row.records) {
    return CallError(Reason::kPieceIndex,
                     absl::StrCat("piece ", first_record, " of a result with ", row.records),
                     {.key = "pieces", .value = absl::StrCat(row.records)});
  }
  BCCSKEL_ASSIGN_OR_RETURN(ResultFile file,
                           blobs.OpenResult(row.tenant, row.file, row.file_digest));
  return std::shared_ptr<ResultReader>(
      new ResultReader(row.tenant, std::move(file), first_record, threads));
}

void ResultReader::Next(std::function<void(absl::StatusOr<std::optional<ResultRecord>>)> done) {
  threads_.Post({.tenant = tenant_},
                [self = shared_from_this(), done = std::move(done)] { done(self->Read()); });
}

absl::StatusOr<std::optional<ResultRecord>> ResultReader::Read() {
  if (next_ == file_.records()) return std::nullopt;
  BCCSKEL_ASSIGN_OR_RETURN(ResultFile::Record record, file_.Read(next_));
  ++next_;
  return std::optional(ResultRecord{.kind = static_cast<ResultRecord::Kind>(record.kind),
                                    .bytes = std::move(record.bytes)});
}

}  // namespace bccskel::server
