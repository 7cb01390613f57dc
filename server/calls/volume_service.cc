#include <string>
#include <utility>
#include <vector>

#include "server/calls/durable_calls.h"
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

}  // namespace

grpc::ServerReadReactor<v1::UploadVolumeRequest>* VolumeService::UploadVolume(
    grpc::CallbackServerContext* context, v1::UploadVolumeResponse* response) {
  return StartUpload(gate_.Enter(*context, kUploadVolume), writers_, limits_, *response);
}

grpc::ServerUnaryReactor* VolumeService::GetUploadStatus(grpc::CallbackServerContext* context,
                                                         const v1::GetUploadStatusRequest* request,
                                                         v1::GetUploadStatusResponse* response) {
  return ServeUnary(gate_, *context, kGetUploadStatus, {"upload", request->upload()},
                    [&](const DurableCall& call, const UnaryEnd& end) {
                      call.durable_jobs.GetUpload(call.tenant(), request->upload(),
                                                  Answer(end, [response](const UploadInfo& upload) {
                                                    *response->mutable_upload() = ToMessage(upload);
                                                  }));
                    });
}

grpc::ServerUnaryReactor* VolumeService::DeleteUpload(grpc::CallbackServerContext* context,
                                                      const v1::DeleteUploadRequest* request,
                                                      v1::DeleteUploadResponse*) {
  return ServeUnary(gate_, *context, kDeleteUpload, {"upload", request->upload()},
                    [&](const DurableCall& call, const UnaryEnd& end) {
                      call.durable_jobs.DeleteUpload(call.tenant(), request->upload(),
                                                     AnswerNothing(end));
                    });
}

grpc::ServerUnaryReactor* VolumeService::FindMissingVolumes(
    grpc::CallbackServerContext* context, const v1::FindMissingVolumesRequest* request,
    v1::FindMissingVolumesResponse* response) {
  const absl::StatusOr<DurableCall> call = gate_.Enter(*context, kFindMissingVolumes);
  if (!call.ok()) return EndUnary(*context, call.status());
  const UnaryEnd end(*context, call->facts, std::string());
  absl::StatusOr<std::vector<StoredKey>> keys = KeysOf(*request);
  if (!keys.ok()) return end(keys.status());
  std::vector<std::string> digests;
  for (const StoredKey& key : *keys) digests.push_back(key.digest);
  call->durable_jobs.FindVolumes(
      call->tenant(), digests,
      Answer(end, [response, keys = *std::move(keys)](const std::vector<VolumeInfo>& found) {
        for (const StoredKey& key : keys) response->add_volumes(NameOf(key, found));
      }));
  return end.reactor();
}

grpc::ServerUnaryReactor* VolumeService::DeleteVolume(grpc::CallbackServerContext* context,
                                                      const v1::DeleteVolumeRequest* request,
                                                      v1::DeleteVolumeResponse*) {
  return ServeUnary(gate_, *context, kDeleteVolume, {"volume", request->volume()},
                    [&](const DurableCall& call, const UnaryEnd& end) {
                      call.durable_jobs.DeleteVolume(call.tenant(), request->volume(),
                                                     AnswerNothing(end));
                    });
}

}  // namespace bccskel::server
