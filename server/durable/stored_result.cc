#include "server/durable/stored_result.h"

#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/digest/random_id.h"
#include "core/exec/status_macros.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

absl::StatusOr<ResultRow> WriteFile(const JobResult& result, const Run& run,
                                    const std::string& file, const JobCodec& codec,
                                    const BlobStore& blobs,
                                    const std::function<absl::Status(uint64_t)>& take) {
  ResultRow row = {
      .tenant = run.tenant(), .key = {}, .file = file, .file_digest = {}, .summary = {}};
  BCCSKEL_ASSIGN_OR_RETURN(ResultWriter writer, blobs.NewResult(row.tenant, file));
  BCCSKEL_RETURN_IF_ERROR(
      codec.WriteResult(result, [&](const ResultRecord& record) -> absl::Status {
        if (run.cancelled()) return absl::CancelledError("the run was cancelled");
        BCCSKEL_RETURN_IF_ERROR(take(record.bytes.size()));
        if (record.kind == ResultRecord::Kind::kSummary) row.summary = record.bytes;
        return writer.Add(static_cast<uint8_t>(record.kind), record.bytes);
      }));
  BCCSKEL_ASSIGN_OR_RETURN(const Sha256Digest digest, writer.Finish());
  row.file_digest = digest.Hex();
  row.bytes = writer.bytes();
  row.records = writer.records();
  return row;
}

}  // namespace

absl::StatusOr<ResultRow> WriteResult(const JobResult& result, const Run& run,
                                      const JobCodec& codec, const BlobStore& blobs,
                                      DiskQuota& quota) {
  const std::string file = RandomId();
  uint64_t taken = 0;
  const auto take = [&](uint64_t bytes) {
    absl::Status status = quota.Take(run.tenant(), bytes);
    if (status.ok()) taken += bytes;
    return status;
  };
  absl::StatusOr<ResultRow> row = WriteFile(result, run, file, codec, blobs, take);
  if (row.ok()) quota.Count(run.tenant(), row->bytes);
  quota.GiveBack(run.tenant(), taken);
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
