#ifndef BCCSKEL_SERVER_CALLS_DURABLE_SESSION_H_
#define BCCSKEL_SERVER_CALLS_DURABLE_SESSION_H_

#include <memory>

#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "server/calls/session.h"
#include "server/calls/upload_writers.h"
#include "server/durable/durable_jobs.h"

namespace bccskel::server {

using SkeletonizeSession = Session<v1::SkeletonizeRequest, v1::SkeletonizeResponse>;

// Whether a call with this config is durable where anything is: volumes that may take more than
// 1 MiB decoded are.
bool IsDurable(const v1::SkeletonizeConfig& config, const VolumeLimits& limits);

// Of a Skeletonize call whose upload and job are kept: uploads, watches the job, reads the stored
// result, of which one piece is in memory at a time.
// Needs: `durable_jobs` and `writers` outlive the session.
std::shared_ptr<SkeletonizeSession> MakeDurableSession(
    std::shared_ptr<SkeletonizeSession::Call> call, DurableJobs& durable_jobs,
    UploadWriters& writers);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_DURABLE_SESSION_H_
