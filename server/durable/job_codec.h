#ifndef BCCSKEL_SERVER_DURABLE_JOB_CODEC_H_
#define BCCSKEL_SERVER_DURABLE_JOB_CODEC_H_

#include <functional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/durable/records.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// Converts between requests, results and the bytes that DurableJobs stores. Keeps messages out of
// DurableJobs, so that the thread sanitizer can check it.
// Threads: safe.
class JobCodec {
 public:
  virtual ~JobCodec() = default;

  // The request for the runner, without a deadline. Empty options mean the defaults.
  // Errors: INVALID_ARGUMENT with the field; RESOURCE_EXHAUSTED for a volume over a limit.
  virtual absl::StatusOr<JobRequest> RequestOf(const std::string& declaration,
                                               const std::string& options) const = 0;

  // The options in a form that is equal where their effect on the request's volume is. Needs:
  // `request` was made from them.
  virtual std::string OptionsFor(const JobRequest&, const std::string& options) const {
    return options;
  }

  // Splits a result into records, one at a time. Errors: those of `sink`.
  using RecordSink = std::function<absl::Status(const ResultRecord& record)>;
  virtual absl::Status WriteResult(const JobResult& result, const RecordSink& sink) const = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_JOB_CODEC_H_
