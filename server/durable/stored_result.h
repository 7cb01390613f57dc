#ifndef BCCSKEL_SERVER_DURABLE_STORED_RESULT_H_
#define BCCSKEL_SERVER_DURABLE_STORED_RESULT_H_

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "server/durable/job_codec.h"
#include "server/durable/records.h"
#include "server/durable/run.h"
#include "server/jobs/task_threads.h"
#include "server/store/blob_store.h"
#include "server/store/disk_quota.h"

namespace bccskel::server {

// Reads a stored result record by record. The file stays readable while the reader lives, even if
// the result is deleted or expires.
// Threads: one call of Next() at a time.
class ResultReader : public std::enable_shared_from_this<ResultReader> {
 public:
  // Reads on `threads`, which must outlive the last pending Next().
  // Errors: OUT_OF_RANGE for a first record beyond the end; DATA_LOSS.
  static absl::StatusOr<std::shared_ptr<ResultReader>> Open(const ResultRow& row,
                                                            uint64_t first_record,
                                                            const BlobStore& blobs,
                                                            TaskThreads& threads);
  // Yields nullopt after the last record. Errors: DATA_LOSS; INTERNAL.
  void Next(std::function<void(absl::StatusOr<std::optional<ResultRecord>>)> done);

 private:
  ResultReader(std::string tenant, ResultFile file, uint64_t next, TaskThreads& threads)
      : tenant_(std::move(tenant)), file_(std::move(file)), next_(next), threads_(threads) {}
  absl::StatusOr<std::optional<ResultRecord>> Read();

  const std::string tenant_;
  const ResultFile file_;
  uint64_t next_;
  TaskThreads& threads_;
};

// Writes the run's result to a file and counts its bytes. The caller sets the row's key. After an
// error there is no file.
// Errors: RESOURCE_EXHAUSTED for quota and disk; CANCELLED once the run is; the codec's.
absl::StatusOr<ResultRow> WriteResult(const JobResult& result, const Run& run,
                                      const JobCodec& codec, const BlobStore& blobs,
                                      DiskQuota& quota);
// Removes the file and its bytes from the count.
void RemoveResult(const ResultRow& row, const BlobStore& blobs, DiskQuota& quota);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_STORED_RESULT_H_
