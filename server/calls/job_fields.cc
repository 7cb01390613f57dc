#include "server/calls/job_fields.h"

#include <algorithm>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/calls/message_codec.h"
#include "server/calls/durable_messages.h"
#include "server/calls/volume_fields.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

constexpr size_t kMaxRequestIdBytes = 128;
constexpr int kMaxPageSize = 1000, kDefaultPageSize = 50;

absl::Status CheckRequestId(const std::string& id) {
  const auto printable = [](char c) { return c > ' ' && c <= '~'; };
  if (id.size() <= kMaxRequestIdBytes && std::ranges::all_of(id, printable)) {
    return absl::OkStatus();
  }
  return InvalidField("request_id", absl::StrCat("must be up to ", kMaxRequestIdBytes,
                                                       " printable ASCII characters"));
}

}  // namespace

absl::StatusOr<Ledger::NewJob> NewJobOf(const v1::CreateJobRequest& request) {
  Ledger::NewJob job;
  BCCSKEL_RETURN_IF_ERROR(CheckRequestId(request.request_id()));
  BCCSKEL_RETURN_IF_ERROR(CheckThreads(request.threads(), "threads"));
  BCCSKEL_ASSIGN_OR_RETURN(job.options,
                           OptionsBytes(request.options(), request.thin_volume_return()));
  BCCSKEL_ASSIGN_OR_RETURN(job.priority, PriorityOf(request.priority(), "priority"));
  job.request_id = request.request_id();
  job.volume = request.volume();
  job.threads = request.threads();
  if (request.validate_only()) job.mode = Ledger::NewJob::Mode::kValidateOnly;
  return job;
}

absl::StatusOr<Ledger::JobQuery> QueryOf(const v1::ListJobsRequest& request) {
  const int wanted = request.page_size();
  if (wanted < 0 || wanted > kMaxPageSize) {
    return InvalidField("page_size", absl::StrCat(wanted, ", must be 0 to ", kMaxPageSize));
  }
  Ledger::JobQuery query;
  query.page_size = wanted == 0 ? kDefaultPageSize : wanted;
  query.page_token = request.page_token();
  for (const int state : request.states()) {
    BCCSKEL_ASSIGN_OR_RETURN(JobState known, StateOf(static_cast<v1::JobState>(state), "states"));
    query.states.push_back(known);
  }
  return query;
}

}  // namespace bccskel::server
