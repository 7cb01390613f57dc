#ifndef BCCSKEL_SERVER_CALLS_VOLUME_SERVICE_H_
#define BCCSKEL_SERVER_CALLS_VOLUME_SERVICE_H_

#include "bccskel/v1/volume_service.grpc.pb.h"
#include "server/jobs/job_pool.h"
#include "server/calls/durable_gate.h"
#include "server/calls/upload_writers.h"

namespace bccskel::server {

class VolumeService final : public v1::VolumeService::CallbackService {
 public:
  // Needs: `gate`, its ledger and `writers` outlive the service's calls.
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

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_VOLUME_SERVICE_H_
