#ifndef BCCSKEL_SERVER_CALLS_SERVICES_H_
#define BCCSKEL_SERVER_CALLS_SERVICES_H_

#include <functional>

#include "bccskel/v1/admin_service.grpc.pb.h"
#include "bccskel/v1/job_service.grpc.pb.h"
#include "bccskel/v1/server_service.grpc.pb.h"
#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "bccskel/v1/volume_service.grpc.pb.h"
#include "server/calls/call_gate.h"
#include "server/calls/upload_writers.h"
#include "server/durable/durable_jobs.h"
#include "server/durable/durable_options.h"
#include "server/jobs/job_pool.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

class SkeletonizationService final : public v1::SkeletonizationService::CallbackService {
 public:
  // Needs: all outlive the service's calls. `DurableJobs` is null where nothing is durable.
  SkeletonizationService(const CallGate& gate, JobRunner& runner, const VolumeLimits& limits,
                         DurableJobs* durable_jobs, UploadWriters& writers)
      : gate_(gate),
        runner_(runner),
        limits_(limits),
        durable_jobs_(durable_jobs),
        writers_(writers) {}

  grpc::ServerBidiReactor<v1::SkeletonizeRequest, v1::SkeletonizeResponse>* Skeletonize(
      grpc::CallbackServerContext* context) override;
  grpc::ServerBidiReactor<v1::SkeletonizeLabelsRequest, v1::SkeletonizeLabelsResponse>*
  SkeletonizeLabels(grpc::CallbackServerContext* context) override;

 private:
  const CallGate& gate_;
  JobRunner& runner_;
  const VolumeLimits limits_;
  DurableJobs* const durable_jobs_;
  UploadWriters& writers_;
};

class VolumeService final : public v1::VolumeService::CallbackService {
 public:
  // Needs: `gate`, its DurableJobs and `writers` outlive the service's calls.
  VolumeService(const DurableGate& gate, UploadWriters& writers, const JobPool::Limits& limits)
      : gate_(gate), writers_(writers), limits_(limits) {}

  grpc::ServerReadReactor<v1::UploadVolumeRequest>* UploadVolume(
      grpc::CallbackServerContext* context, v1::UploadVolumeResponse* response) override;
  grpc::ServerUnaryReactor* GetUploadStatus(grpc::CallbackServerContext* context,
                                            const v1::GetUploadStatusRequest* request,
                                            v1::GetUploadStatusResponse* response) override;
  grpc::ServerUnaryReactor* DeleteUpload(grpc::CallbackServerContext* context,
                                         const v1::DeleteUploadRequest* request,
                                         v1::DeleteUploadResponse* response) override;
  grpc::ServerUnaryReactor* FindMissingVolumes(grpc::CallbackServerContext* context,
                                               const v1::FindMissingVolumesRequest* request,
                                               v1::FindMissingVolumesResponse* response) override;
  grpc::ServerUnaryReactor* DeleteVolume(grpc::CallbackServerContext* context,
                                         const v1::DeleteVolumeRequest* request,
                                         v1::DeleteVolumeResponse* response) override;

 private:
  const DurableGate& gate_;
  UploadWriters& writers_;
  const JobPool::Limits limits_;
};

class JobService final : public v1::JobService::CallbackService {
 public:
  // Needs: `gate` and its DurableJobs outlive the service's calls.
  explicit JobService(const DurableGate& gate) : gate_(gate) {}

  grpc::ServerUnaryReactor* CreateJob(grpc::CallbackServerContext* context,
                                      const v1::CreateJobRequest* request,
                                      v1::CreateJobResponse* response) override;
  grpc::ServerUnaryReactor* GetJob(grpc::CallbackServerContext* context,
                                   const v1::GetJobRequest* request,
                                   v1::GetJobResponse* response) override;
  grpc::ServerUnaryReactor* ListJobs(grpc::CallbackServerContext* context,
                                     const v1::ListJobsRequest* request,
                                     v1::ListJobsResponse* response) override;
  grpc::ServerUnaryReactor* CancelJob(grpc::CallbackServerContext* context,
                                      const v1::CancelJobRequest* request,
                                      v1::CancelJobResponse* response) override;
  grpc::ServerUnaryReactor* DeleteJob(grpc::CallbackServerContext* context,
                                      const v1::DeleteJobRequest* request,
                                      v1::DeleteJobResponse* response) override;
  grpc::ServerWriteReactor<v1::WatchJobResponse>* WatchJob(
      grpc::CallbackServerContext* context, const v1::WatchJobRequest* request) override;
  grpc::ServerWriteReactor<v1::ReadSkeletonResponse>* ReadSkeleton(
      grpc::CallbackServerContext* context, const v1::ReadSkeletonRequest* request) override;

 private:
  const DurableGate& gate_;
};

inline constexpr int kMaxMessageBytes = 4 << 20;

class ServerService final : public v1::ServerService::CallbackService {
 public:
  // Needs: `gate` outlives the service's calls.
  ServerService(const CallGate& gate, const JobPool::Limits& limits, const DurableOptions& durable)
      : gate_(gate), limits_(limits), durable_(durable) {}

  grpc::ServerUnaryReactor* GetCapabilities(grpc::CallbackServerContext* context,
                                            const v1::GetCapabilitiesRequest* request,
                                            v1::GetCapabilitiesResponse* response) override;

 private:
  const CallGate& gate_;
  const JobPool::Limits limits_;
  const DurableOptions durable_;
};

class AdminService final : public v1::AdminService::CallbackService {
 public:
  // Makes the answer at once. Threads: must be safe.
  using StatusSource = std::function<v1::GetServerStatusResponse()>;

  // Needs: `gate`, and what `status` asks, outlive the service's calls.
  AdminService(const CallGate& gate, StatusSource status)
      : gate_(gate), status_(std::move(status)) {}

  grpc::ServerUnaryReactor* GetServerStatus(grpc::CallbackServerContext* context,
                                            const v1::GetServerStatusRequest* request,
                                            v1::GetServerStatusResponse* response) override;

 private:
  const CallGate& gate_;
  const StatusSource status_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_SERVICES_H_
