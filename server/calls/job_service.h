#ifndef BCCSKEL_SERVER_CALLS_JOB_SERVICE_H_
#define BCCSKEL_SERVER_CALLS_JOB_SERVICE_H_

#include "bccskel/v1/job_service.grpc.pb.h"
#include "server/calls/durable_gate.h"

namespace bccskel::server {

class JobService final : public v1::JobService::CallbackService {
 public:
  // Needs: `gate` and its ledger outlive the service's calls.
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

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_JOB_SERVICE_H_
