#ifndef BCCSKEL_SERVER_CALLS_DURABLE_SESSION_H_
#define BCCSKEL_SERVER_CALLS_DURABLE_SESSION_H_

#include <memory>

#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "server/calls/session.h"
#include "server/calls/upload_writers.h"
#include "server/durable/durable_jobs.h"

namespace bccskel::server {

using SkeletonizeSession = Session<v1::SkeletonizeRequest, v1::SkeletonizeResponse>;

// Whether a call with this config is durable on a server with a data directory: if the volume may
// take more than 1 MiB decoded.
bool IsDurable(const v1::SkeletonizeConfig& config, const VolumeLimits& limits);

// The session of a durable Skeletonize call: stores the upload, watches the job and reads the
// stored result, one piece in memory at a time.
// Needs: `durable_jobs` and `writers` outlive the session.
std::shared_ptr<SkeletonizeSession> MakeDurableSession(
    std::shared_ptr<SkeletonizeSession::Call> call, DurableJobs& durable_jobs,
    UploadWriters& writers);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_DURABLE_SESSION_H_
