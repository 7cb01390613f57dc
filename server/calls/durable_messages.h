#ifndef BCCSKEL_SERVER_CALLS_DURABLE_MESSAGES_H_
#define BCCSKEL_SERVER_CALLS_DURABLE_MESSAGES_H_

#include <google/protobuf/timestamp.pb.h>

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "bccskel/v1/job_service.pb.h"
#include "bccskel/v1/volume_service.pb.h"
#include "server/durable/durable_jobs.h"
#include "server/durable/records.h"

namespace bccskel::server {

// Convert records of DurableJobs to messages.
google::protobuf::Timestamp ToMessage(Time time);
v1::Upload ToMessage(const UploadInfo& upload);
v1::Job ToMessage(const JobInfo& job);
v1::WatchJobResponse ToMessage(const JobEvent& event);
v1::JobState ToMessage(JobState state);

// What identifies a volume in DurableJobs.
struct StoredKey {
  std::string declaration;
  std::string digest;

  bool IsOf(const VolumeInfo& volume) const {
    return volume.blob_digest == digest && volume.declaration == declaration;
  }
};

// Convert requests to the input of DurableJobs. Errors: INVALID_ARGUMENT with the field.
absl::StatusOr<NewJob> NewJobOf(const v1::CreateJobRequest& request);
absl::StatusOr<JobQuery> QueryOf(const v1::ListJobsRequest& request);
absl::StatusOr<std::vector<StoredKey>> KeysOf(const v1::FindMissingVolumesRequest& request);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_DURABLE_MESSAGES_H_
