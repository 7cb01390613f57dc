#include "client/grpc_durable_stub.h"

#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <string>

#include "bccskel/v1/job_service.grpc.pb.h"
#include "bccskel/v1/volume_service.grpc.pb.h"
#include "client/channel.h"
#include "client/durable_client.h"
#include "client/grpc_attempt.h"
#include "client/grpc_status.h"
#include "client/job_messages.h"
#include "client/skeleton_reading.h"
#include "core/digest/crc32c.h"
#include "core/digest/sha256.h"
#include "core/exec/status_macros.h"

namespace bccskel::client {
namespace {

// Small enough that a broken stream costs little, large enough for full speed.
constexpr size_t kChunkBytes = 512 * 1024;

v1::UploadVolumeRequest ConfigRequest(const std::string& upload, const EncodedVolume& volume) {
  v1::UploadVolumeRequest request;
  request.mutable_config()->set_upload(upload);
  *request.mutable_config()->mutable_volume() = DeclarationOf(volume);
  return request;
}

v1::UploadVolumeRequest ChunkRequest(const EncodedVolume& volume, size_t offset) {
  v1::UploadVolumeRequest request;
  v1::VolumeChunk& chunk = *request.mutable_chunk();
  chunk.set_offset(offset);
  chunk.set_data(volume.bytes.substr(offset, kChunkBytes));
  chunk.set_crc32c(Crc32c(chunk.data()));
  return request;
}

v1::UploadVolumeRequest FinishRequest(const EncodedVolume& volume) {
  const Sha256Digest digest = Sha256Of(volume.bytes);
  v1::UploadVolumeRequest request;
  request.mutable_finish()->set_size_bytes(volume.bytes.size());
  request.mutable_finish()->set_sha256(digest.bytes.data(), digest.bytes.size());
  return request;
}

template <typename Request>
Request RequestAbout(const std::string& job) {
  Request request;
  request.set_job(job);
  return request;
}

template <typename Response>
absl::StatusOr<DurableJob> JobIn(const absl::StatusOr<Response>& response) {
  if (!response.ok()) return response.status();
  return FromMessage(response->job());
}

class GrpcDurableStub final : public DurableStub {
  using Volumes = v1::VolumeService::StubInterface;
  using Jobs = v1::JobService::StubInterface;

 public:
  explicit GrpcDurableStub(const std::shared_ptr<grpc::Channel>& channel)
      : channel_(channel),
        volumes_(v1::VolumeService::NewStub(channel)),
        jobs_(v1::JobService::NewStub(channel)) {}

  absl::StatusOr<std::string> FindVolume(const EncodedVolume& volume,
                                         const Limits& limits) override {
    const Sha256Digest digest = Sha256Of(volume.bytes);
    v1::FindMissingVolumesRequest request;
    v1::VolumeKey& key = *request.add_volumes();
    *key.mutable_declaration() = DeclarationOf(volume);
    key.set_blob_sha256(digest.bytes.data(), digest.bytes.size());
    BCCSKEL_ASSIGN_OR_RETURN(const v1::FindMissingVolumesResponse response,
                             Ask(*volumes_, &Volumes::FindMissingVolumes, request, limits));
    if (response.volumes_size() == 1) return response.volumes(0);
    return absl::DataLossError("the server's answer is for a different number of volumes");
  }

  absl::StatusOr<std::string> Upload(const std::string& upload, Begun begun,
                                     const EncodedVolume& volume, const Limits& limits) override {
    uint64_t committed = 0;
    if (begun == Begun::kMaybe) {
      BCCSKEL_ASSIGN_OR_RETURN(committed, CommittedSize(upload, limits));
    }
    return Attempt(*channel_, limits, [&](grpc::ClientContext& context) {
      return Send(context, upload, volume, committed);
    });
  }

  absl::StatusOr<DurableJob> CreateJob(const NewJob& job, const Limits& limits) override {
    return JobIn(Ask(*jobs_, &Jobs::CreateJob, ToMessage(job), limits));
  }

  absl::StatusOr<DurableJob> GetJob(const std::string& job, const Limits& limits) override {
    return JobIn(Ask(*jobs_, &Jobs::GetJob, RequestAbout<v1::GetJobRequest>(job), limits));
  }

  absl::StatusOr<JobPage> ListJobs(int page_size, const std::string& page_token,
                                   const Limits& limits) override {
    v1::ListJobsRequest request;
    request.set_page_size(page_size);
    request.set_page_token(page_token);
    BCCSKEL_ASSIGN_OR_RETURN(const v1::ListJobsResponse response,
                             Ask(*jobs_, &Jobs::ListJobs, request, limits));
    JobPage page;
    for (const v1::Job& job : response.jobs()) page.jobs.push_back(FromMessage(job));
    page.next_token = response.next_page_token();
    return page;
  }

  absl::StatusOr<DurableJob> CancelJob(const std::string& job, const Limits& limits) override {
    return JobIn(Ask(*jobs_, &Jobs::CancelJob, RequestAbout<v1::CancelJobRequest>(job), limits));
  }

  absl::Status DeleteJob(const std::string& job, const Limits& limits) override {
    return Ask(*jobs_, &Jobs::DeleteJob, RequestAbout<v1::DeleteJobRequest>(job), limits).status();
  }

  absl::Status WatchJob(const std::string& job, uint64_t after_sequence,
                        const EventConsumer& consume, const Limits& limits) override {
    auto request = RequestAbout<v1::WatchJobRequest>(job);
    request.set_after_sequence(after_sequence);
    return Attempt(*channel_, limits, [&](grpc::ClientContext& context) {
      const auto stream = jobs_->WatchJob(&context, request);
      v1::WatchJobResponse response;
      while (stream->Read(&response)) {
        if (const auto event = FromMessage(response); event.has_value()) consume(*event);
      }
      return FromGrpcStatus(stream->Finish());
    });
  }

  absl::Status ReadSkeleton(const std::string& job, SkeletonReading& reading,
                            const Limits& limits) override {
    auto request = RequestAbout<v1::ReadSkeletonRequest>(job);
    request.set_piece_index(reading.pieces());
    return Attempt(*channel_, limits, [&](grpc::ClientContext& context) {
      const auto stream = jobs_->ReadSkeleton(&context, request);
      v1::ReadSkeletonResponse piece;
      absl::Status taken;
      while (taken.ok() && stream->Read(&piece)) taken = reading.Add(piece);
      if (!taken.ok()) context.TryCancel();
      const absl::Status ended = FromGrpcStatus(stream->Finish());
      return taken.ok() ? ended : taken;
    });
  }

 private:
  // A call with one request and one response.
  template <typename Stub, typename Request, typename Response>
  absl::StatusOr<Response> Ask(Stub& stub,
                               grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&,
                                                            Response*),
                               const Request& request, const Limits& limits) {
    return Attempt(
        *channel_, limits, [&](grpc::ClientContext& context) -> absl::StatusOr<Response> {
          Response response;
          BCCSKEL_RETURN_IF_ERROR(FromGrpcStatus((stub.*method)(&context, request, &response)));
          return response;
        });
  }

  // 0 for an upload that the server does not know.
  absl::StatusOr<uint64_t> CommittedSize(const std::string& upload, const Limits& limits) {
    v1::GetUploadStatusRequest request;
    request.set_upload(upload);
    const auto response = Ask(*volumes_, &Volumes::GetUploadStatus, request, limits);
    if (absl::IsNotFound(response.status())) return 0;
    if (!response.ok()) return response.status();
    return response->upload().committed_size();
  }

  absl::StatusOr<std::string> Send(grpc::ClientContext& context, const std::string& upload,
                                   const EncodedVolume& volume, uint64_t committed) {
    v1::UploadVolumeResponse response;
    const auto stream = volumes_->UploadVolume(&context, &response);
    // A failed write means that the call has ended; Finish() yields the reason.
    bool open = stream->Write(ConfigRequest(upload, volume));
    for (size_t at = committed; open && at < volume.bytes.size(); at += kChunkBytes) {
      open = stream->Write(ChunkRequest(volume, at));
    }
    if (open && stream->Write(FinishRequest(volume))) stream->WritesDone();
    BCCSKEL_RETURN_IF_ERROR(FromGrpcStatus(stream->Finish()));
    if (!response.upload().volume().empty()) return response.upload().volume();
    return absl::DataLossError("the server names no volume for " + upload);
  }

  const std::shared_ptr<grpc::Channel> channel_;
  const std::unique_ptr<Volumes> volumes_;
  const std::unique_ptr<Jobs> jobs_;
};

}  // namespace

std::unique_ptr<DurableStub> MakeDurableStub(const std::shared_ptr<grpc::Channel>& channel) {
  return std::make_unique<GrpcDurableStub>(channel);
}

absl::StatusOr<std::unique_ptr<DurableStub>> MakeGrpcDurableStub(const Endpoint& endpoint) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::shared_ptr<grpc::Channel> channel, OpenChannel(endpoint));
  return MakeDurableStub(channel);
}

}  // namespace bccskel::client
