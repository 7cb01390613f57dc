#include <memory>
#include <string>
#include <vector>

#include "bccskel/v1/volume_service.grpc.pb.h"
#include "server/calls/durable_messages.h"
#include "server/calls/services.h"
#include "server/calls/unary_answer.h"

namespace bccskel::server {
namespace {

constexpr Method kUploadVolume{"VolumeService/UploadVolume"};
constexpr Method kGetUploadStatus{"VolumeService/GetUploadStatus", Method::Kind::kQuestion};
constexpr Method kDeleteUpload{"VolumeService/DeleteUpload"};
constexpr Method kFindMissingVolumes{"VolumeService/FindMissingVolumes", Method::Kind::kQuestion};
constexpr Method kDeleteVolume{"VolumeService/DeleteVolume"};

std::string NameOf(const StoredKey& key, const std::vector<VolumeInfo>& volumes) {
  for (const VolumeInfo& volume : volumes) {
    if (key.IsOf(volume)) return volume.name;
  }
  return std::string();
}

class VolumeService final : public v1::VolumeService::CallbackService {
 public:
  VolumeService(const CallGate& gate, UploadWriters& writers, const JobPool::Limits& limits)
      : gate_(gate), writers_(writers), limits_(limits) {}

  grpc::ServerReadReactor<v1::UploadVolumeRequest>* UploadVolume(
      Context* context, v1::UploadVolumeResponse* response) override {
    return StartUpload(gate_.EnterDurable(*context, kUploadVolume), writers_, limits_, *response);
  }
  grpc::ServerUnaryReactor* GetUploadStatus(Context* context,
                                            const v1::GetUploadStatusRequest* request,
                                            v1::GetUploadStatusResponse* response) override {
    return AskDurable(gate_, *context, kGetUploadStatus, {"upload", request->upload()},
                      &DurableJobs::GetUpload, Answer([response](const UploadInfo& upload) {
                        *response->mutable_upload() = ToMessage(upload);
                      }));
  }
  grpc::ServerUnaryReactor* DeleteUpload(Context* context, const v1::DeleteUploadRequest* request,
                                         v1::DeleteUploadResponse*) override {
    return AskDurable(gate_, *context, kDeleteUpload, {"upload", request->upload()},
                      &DurableJobs::DeleteUpload, AnswerNothing);
  }
  grpc::ServerUnaryReactor* FindMissingVolumes(Context* context,
                                               const v1::FindMissingVolumesRequest* request,
                                               v1::FindMissingVolumesResponse* response) override {
    const absl::StatusOr<std::vector<StoredKey>> keys = KeysOf(*request);
    const auto read = [&](const DurableCall&) -> absl::StatusOr<std::vector<std::string>> {
      if (!keys.ok()) return keys.status();
      std::vector<std::string> digests;
      for (const StoredKey& key : *keys) digests.push_back(key.digest);
      return digests;
    };
    const auto fill = [response, keys](const std::vector<VolumeInfo>& found) {
      for (const StoredKey& key : *keys) response->add_volumes(NameOf(key, found));
    };
    return AskDurable(*context, gate_.EnterDurable(*context, kFindMissingVolumes), std::string(),
                      read, &DurableJobs::FindVolumes, Answer(fill));
  }
  grpc::ServerUnaryReactor* DeleteVolume(Context* context, const v1::DeleteVolumeRequest* request,
                                         v1::DeleteVolumeResponse*) override {
    return AskDurable(gate_, *context, kDeleteVolume, {"volume", request->volume()},
                      &DurableJobs::DeleteVolume, AnswerNothing);
  }

 private:
  const CallGate& gate_;
  UploadWriters& writers_;
  const JobPool::Limits limits_;
};

}  // namespace

std::unique_ptr<grpc::Service> MakeVolumeService(const CallGate& gate, UploadWriters& writers,
                                                 const JobPool::Limits& limits) {
  return std::make_unique<VolumeService>(gate, writers, limits);
}

}  // namespace bccskel::server
