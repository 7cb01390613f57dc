#ifndef BCCSKEL_SERVER_CALLS_SERVICES_H_
#define BCCSKEL_SERVER_CALLS_SERVICES_H_

#include <grpcpp/grpcpp.h>

#include <functional>
#include <memory>

#include "absl/status/statusor.h"
#include "bccskel/v1/admin_service.pb.h"
#include "bccskel/v1/job_service.pb.h"
#include "bccskel/v1/volume_service.pb.h"
#include "server/calls/call_gate.h"
#include "server/calls/upload_writers.h"
#include "server/durable/durable_options.h"
#include "server/jobs/job_pool.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

inline constexpr int kMaxMessageBytes = 4 << 20;

// The services of the interface. Needs: every argument passed by reference outlives their calls.
std::unique_ptr<grpc::Service> MakeSkeletonizationService(const CallGate& gate, JobRunner& runner,
                                                          const VolumeLimits& limits,
                                                          UploadWriters& writers);
std::unique_ptr<grpc::Service> MakeVolumeService(const CallGate& gate, UploadWriters& writers,
                                                 const JobPool::Limits& limits);
std::unique_ptr<grpc::Service> MakeJobService(const CallGate& gate);
std::unique_ptr<grpc::Service> MakeServerService(const CallGate& gate,
                                                 const JobPool::Limits& limits,
                                                 const DurableOptions& durable);
// `status` computes the response without blocking. Threads: it must be safe.
using StatusSource = std::function<v1::GetServerStatusResponse()>;
std::unique_ptr<grpc::Service> MakeAdminService(const CallGate& gate, StatusSource status);

// Start the handlers of streaming calls about durable data. Needs: the call's DurableJobs and
// `writers` outlive the call; gRPC keeps `response` until its end.
grpc::ServerReadReactor<v1::UploadVolumeRequest>* StartUpload(absl::StatusOr<DurableCall> call,
                                                              UploadWriters& writers,
                                                              const JobPool::Limits& limits,
                                                              v1::UploadVolumeResponse& response);
grpc::ServerWriteReactor<v1::WatchJobResponse>* StartWatch(absl::StatusOr<DurableCall> call,
                                                           const v1::WatchJobRequest& request);
grpc::ServerWriteReactor<v1::ReadSkeletonResponse>* StartRead(
    absl::StatusOr<DurableCall> call, const v1::ReadSkeletonRequest& request);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_SERVICES_H_
