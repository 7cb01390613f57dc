#include "server/calls/durable_messages.h"

#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <variant>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "proto/wire/enumerators.h"
#include "proto/wire/result.h"
#include "server/calls/message_codec.h"
#include "server/calls/requests.h"
#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

constexpr std::pair<v1::JobPriority, int> kPriorities[] = {{v1::JOB_PRIORITY_LOW, -1},
                                                           {v1::JOB_PRIORITY_NORMAL, 0},
                                                           {v1::JOB_PRIORITY_UNSPECIFIED, 0},
                                                           {v1::JOB_PRIORITY_HIGH, 1}};
constexpr std::pair<v1::JobState, JobState> kStates[] = {
    {v1::JOB_STATE_RECEIVING, JobState::kReceiving},
    {v1::JOB_STATE_QUEUED, JobState::kQueued},
    {v1::JOB_STATE_RUNNING, JobState::kRunning},
    {v1::JOB_STATE_SUCCEEDED, JobState::kSucceeded},
    {v1::JOB_STATE_FAILED, JobState::kFailed},
    {v1::JOB_STATE_CANCELLED, JobState::kCancelled}};

v1::ShellProgress ProgressMessage(const JobProgress& progress) {
  return wire::ToMessage(progress.shell, progress.elapsed);
}

v1::Status ErrorMessage(const absl::Status& error) { return ToStatusMessage(WithJobReason(error)); }

void SetOutcome(const JobInfo& job, v1::Job& message) {
  if (!job.error.ok()) *message.mutable_error() = ErrorMessage(job.error);
  message.set_result_pieces(static_cast<uint32_t>(job.result_records));
  message.set_result_bytes(job.result_bytes);
  if (!job.summary.empty()) message.mutable_summary()->ParseFromString(job.summary);
  if (job.progress.has_value()) *message.mutable_progress() = ProgressMessage(*job.progress);
}

void SetTimes(const JobInfo& job, v1::Job& message) {
  // A job that was only validated has no times.
  if (job.created != Time()) *message.mutable_create_time() = ToMessage(job.created);
  if (job.started.has_value()) *message.mutable_start_time() = ToMessage(*job.started);
  if (job.ended.has_value()) *message.mutable_end_time() = ToMessage(*job.ended);
  if (job.expires.has_value()) *message.mutable_expire_time() = ToMessage(*job.expires);
}

constexpr size_t kMaxRequestIdBytes = 128;
constexpr int kMaxPageSize = 1000, kDefaultPageSize = 50;
constexpr int kMaxKeys = 256;
constexpr size_t kBlobDigestBytes = 32;

absl::Status CheckRequestId(const std::string& id) {
  const auto printable = [](char c) { return c > ' ' && c <= '~'; };
  if (id.size() <= kMaxRequestIdBytes && std::ranges::all_of(id, printable)) {
    return absl::OkStatus();
  }
  return InvalidField("request_id",
                      absl::StrCat(id.size(), " bytes, must be up to ", kMaxRequestIdBytes,
                                   " printable ASCII characters without spaces"));
}

}  // namespace

google::protobuf::Timestamp ToMessage(Time time) {
  const std::chrono::nanoseconds since = time.time_since_epoch();
  return google::protobuf::util::TimeUtil::NanosecondsToTimestamp(since.count());
}

v1::Upload ToMessage(const UploadInfo& upload) {
  v1::Upload message;
  message.set_name(upload.name);
  message.set_size_bytes(upload.size_bytes);
  message.set_committed_size(upload.committed_bytes);
  message.set_volume(upload.volume);
  message.set_job(upload.job);
  if (upload.volume.empty()) *message.mutable_expire_time() = ToMessage(upload.expires);
  return message;
}

v1::Job ToMessage(const JobInfo& job) {
  v1::Job message;
  message.set_name(job.name);
  message.set_state(ToMessage(job.state));
  message.set_request_id(job.request_id);
  message.set_volume(job.volume);
  message.set_upload(job.upload);
  v1::SkeletonizeConfig config = ConfigOf(job.options);
  message.mutable_options()->Swap(config.mutable_options());
  message.set_thin_volume_return(config.thin_volume_return());
  message.set_priority(wire::EnumeratorOf(job.priority, kPriorities));
  message.set_threads(job.threads);
  message.set_attempts(job.attempts);
  message.set_last_sequence(job.sequence);
  SetTimes(job, message);
  SetOutcome(job, message);
  return message;
}

v1::WatchJobResponse ToMessage(const JobEvent& event) {
  v1::WatchJobResponse message;
  message.set_sequence(event.sequence);
  *message.mutable_time() = ToMessage(event.time);
  if (const auto* progress = std::get_if<JobProgress>(&event.what)) {
    *message.mutable_shell_progress() = ProgressMessage(*progress);
    return message;
  }
  const auto& change = std::get<JobEvent::StateChange>(event.what);
  v1::JobStateChange& state_change = *message.mutable_state_change();
  state_change.set_state(ToMessage(change.state));
  state_change.set_attempt(change.attempt);
  if (!change.error.ok()) *state_change.mutable_error() = ErrorMessage(change.error);
  return message;
}

v1::JobState ToMessage(JobState state) { return wire::EnumeratorOf(state, kStates); }

absl::StatusOr<NewJob> NewJobOf(const v1::CreateJobRequest& request) {
  NewJob job;
  BCCSKEL_RETURN_IF_ERROR(CheckRequestId(request.request_id()));
  BCCSKEL_RETURN_IF_ERROR(CheckThreads(request.threads(), "threads"));
  BCCSKEL_ASSIGN_OR_RETURN(job.options,
                           OptionsBytes(request.options(), request.thin_volume_return()));
  BCCSKEL_ASSIGN_OR_RETURN(
      job.priority, MeaningOf<int>(request.priority(), "priority", "priority ", kPriorities));
  job.request_id = request.request_id();
  job.volume = request.volume();
  job.threads = request.threads();
  if (request.validate_only()) job.mode = NewJob::Mode::kValidateOnly;
  return job;
}

absl::StatusOr<JobQuery> QueryOf(const v1::ListJobsRequest& request) {
  const int wanted = request.page_size();
  if (wanted < 0 || wanted > kMaxPageSize) {
    return InvalidField("page_size", absl::StrCat(wanted, ", must be 0 to ", kMaxPageSize));
  }
  JobQuery query;
  query.page_size = wanted == 0 ? kDefaultPageSize : wanted;
  query.page_token = request.page_token();
  for (const int state : request.states()) {
    BCCSKEL_ASSIGN_OR_RETURN(JobState known, MeaningOf<JobState>(static_cast<v1::JobState>(state),
                                                                 "states", "state ", kStates));
    query.states.push_back(known);
  }
  return query;
}

absl::StatusOr<std::vector<StoredKey>> KeysOf(const v1::FindMissingVolumesRequest& request) {
  if (request.volumes().empty() || request.volumes_size() > kMaxKeys) {
    return InvalidField("volumes",
                        absl::StrCat(request.volumes_size(), " keys, must be 1 to ", kMaxKeys));
  }
  std::vector<StoredKey> keys;
  for (const v1::VolumeKey& key : request.volumes()) {
    if (key.blob_sha256().size() != kBlobDigestBytes) {
      return InvalidField(
          "volumes.blob_sha256",
          absl::StrCat(key.blob_sha256().size(), " bytes, must be ", kBlobDigestBytes));
    }
    keys.push_back(
        {DeclarationBytes(key.declaration()), absl::BytesToHexString(key.blob_sha256())});
  }
  return keys;
}

}  // namespace bccskel::server
