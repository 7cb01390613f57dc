#ifndef BCCSKEL_CLIENT_JOB_MESSAGES_H_
#define BCCSKEL_CLIENT_JOB_MESSAGES_H_

#include <optional>

#include "bccskel/v1/job_service.pb.h"
#include "bccskel/v1/volume.pb.h"
#include "client/durable_job.h"
#include "client/encoded_volume.h"

namespace bccskel::client {

v1::VolumeDeclaration DeclarationOf(const EncodedVolume& volume);

// Convert jobs and reports about them to and from messages.
v1::ThinVolumeReturn ToMessage(ThinVolume thin_volume);
v1::CreateJobRequest ToMessage(const NewJob& job);
DurableJob FromMessage(const v1::Job& message);
// nullopt for heartbeats and for events that this version does not know.
std::optional<JobEvent> FromMessage(const v1::WatchJobResponse& message);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_JOB_MESSAGES_H_
