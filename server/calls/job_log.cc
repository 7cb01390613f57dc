#include "server/calls/job_log.h"

#include <chrono>
#include <iterator>
#include <string>

#include "server/calls/durable_messages.h"
#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"
#include "server/logging/json_log.h"

namespace bccskel::server {
namespace {

// "QUEUED", "RUNNING", ...
std::string NameOf(JobState state) {
  return v1::JobState_Name(ToMessage(state)).substr(std::size("JOB_STATE_") - 1);
}

LogLevel LevelOf(const JobRow& job) {
  if (job.state != JobState::kFailed) return LogLevel::kInfo;
  return absl::IsInternal(job.error) ? LogLevel::kError : LogLevel::kWarning;
}

}  // namespace

void LogJobState(const JobRow& job) {
  const absl::Status error = WithJobReason(job.error);
  const auto since_created = job.ended.value_or(job.started.value_or(job.created)) - job.created;
  Log(LevelOf(job), "job state",
      {{"job", job.name},
       {"tenant", job.tenant},
       {"state", NameOf(job.state)},
       {"attempt", int64_t{job.attempts}},
       {"code", absl::StatusCodeToString(error.code())},
       {"reason", ReasonNameOf(error)},
       {"message", std::string(error.message())},
       {"seconds", std::chrono::duration<double>(since_created).count()},
       {"traceparent", job.trace}});
}

}  // namespace bccskel::server
