#include "client/job_messages.h"

#include <google/protobuf/timestamp.pb.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "proto/wire/enumerators.h"
#include "proto/wire/error_details.h"
#include "proto/wire/options.h"
#include "proto/wire/placement.h"
#include "proto/wire/result.h"
#include "proto/wire/volume_encoding.h"

namespace bccskel::client {
namespace {

constexpr std::pair<v1::JobState, JobState> kStates[] = {
    {v1::JOB_STATE_RECEIVING, JobState::kReceiving},
    {v1::JOB_STATE_QUEUED, JobState::kQueued},
    {v1::JOB_STATE_RUNNING, JobState::kRunning},
    {v1::JOB_STATE_SUCCEEDED, JobState::kSucceeded},
    {v1::JOB_STATE_FAILED, JobState::kFailed},
    {v1::JOB_STATE_CANCELLED, JobState::kCancelled}};
constexpr std::pair<v1::JobPriority, JobPriority> kPriorities[] = {
    {v1::JOB_PRIORITY_LOW, JobPriority::kLow},
    {v1::JOB_PRIORITY_NORMAL, JobPriority::kNormal},
    {v1::JOB_PRIORITY_HIGH, JobPriority::kHigh}};

JobState StateOf(v1::JobState state) {
  return wire::MeaningOf(state, kStates).value_or(JobState::kUnknown);
}

Time TimeOf(const google::protobuf::Timestamp& message) {
  constexpr int64_t kMostSeconds = 9'000'000'000;  // nanoseconds of more do not fit 64 bits
  const auto since =
      std::chrono::seconds(std::clamp(message.seconds(), -kMostSeconds, kMostSeconds)) +
      std::chrono::nanoseconds(message.nanos());
  return Time(std::chrono::duration_cast<Time::duration>(since));
}

}  // namespace

v1::VolumeDeclaration DeclarationOf(const EncodedVolume& volume) {
  v1::VolumeDeclaration declaration;
  declaration.set_encoding(wire::ToMessage(volume.encoding));
  *declaration.mutable_extent() = wire::ToMessage(volume.extent);
  declaration.set_size_bytes(volume.bytes.size());
  // 0 would mean unknown.
  declaration.set_max_bricks(std::max<uint64_t>(volume.bricks, 1));
  return declaration;
}

v1::ThinVolumeReturn ToMessage(ThinVolume thin_volume) {
  return thin_volume == ThinVolume::kReturn ? v1::THIN_VOLUME_RETURN_BRICKS
                                            : v1::THIN_VOLUME_RETURN_OMIT;
}

v1::CreateJobRequest ToMessage(const NewJob& job) {
  v1::CreateJobRequest message;
  message.set_request_id(job.request_id);
  message.set_volume(job.volume);
  *message.mutable_options() = wire::ToMessage(job.options);
  message.set_thin_volume_return(ToMessage(job.thin_volume));
  message.set_priority(wire::EnumeratorOf(job.priority, kPriorities));
  message.set_threads(job.threads);
  return message;
}

DurableJob FromMessage(const v1::Job& message) {
  DurableJob job;
  job.name = message.name();
  job.state = StateOf(message.state());
  job.request_id = message.request_id();
  job.volume = message.volume();
  job.attempts = message.attempts();
  if (message.has_error()) job.error = wire::FromRpcStatus(message.error());
  job.result_bytes = message.result_bytes();
  job.created = TimeOf(message.create_time());
  if (message.has_start_time()) job.started = TimeOf(message.start_time());
  if (message.has_end_time()) job.ended = TimeOf(message.end_time());
  if (message.has_expire_time()) job.expires = TimeOf(message.expire_time());
  return job;
}

std::optional<JobEvent> FromMessage(const v1::WatchJobResponse& message) {
  JobEvent event;
  event.sequence = message.sequence();
  if (message.has_state_change()) {
    const v1::JobStateChange& change = message.state_change();
    event.state = StateOf(change.state());
    if (change.has_error()) event.error = wire::FromRpcStatus(change.error());
    return event;
  }
  if (!message.has_shell_progress()) return std::nullopt;
  event.shell = wire::FromMessage(message.shell_progress());
  return event;
}

}  // namespace bccskel::client
