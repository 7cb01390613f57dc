#ifndef BCCSKEL_SERVER_CALLS_SERVICES_H_
#define BCCSKEL_SERVER_CALLS_SERVICES_H_

#include <grpcpp/grpcpp.h>

#include <functional>
#include <memory>

#include "bccskel/v1/admin_service.pb.h"
#include "server/calls/call_gate.h"
#include "server/calls/upload_writers.h"
#include "server/durable/durable_options.h"
#include "server/jobs/job_pool.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

inline constexpr int kMaxMessageBytes = 4 << 20;

// The services of the interface. Needs of all: what they are given by reference outlives their
// calls.
std::unique_ptr<grpc::Service> MakeSkeletonizationService(const CallGate& gate, JobRunner& runner,
                                                          const VolumeLimits& limits,
                                                          UploadWriters& writers);
std::unique_ptr<grpc::Service> MakeVolumeService(const CallGate& gate, UploadWriters& writers,
                                                 const JobPool::Limits& limits);
std::unique_ptr<grpc::Service> MakeJobService(const CallGate& gate);
std::unique_ptr<grpc::Service> MakeServerService(const CallGate& gate,
                                                 const JobPool::Limits& limits,
                                                 const DurableOptions& durable);
// `status` makes the answer at once. Threads: it must be safe.
using StatusSource = std::function<v1::GetServerStatusResponse()>;
std::unique_ptr<grpc::Service> MakeAdminService(const CallGate& gate, StatusSource status);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_SERVICES_H_
