#include <grpcpp/grpcpp.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bccskel/v1/server_service.grpc.pb.h"
#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "client/channel.h"
#include "client/grpc_attempt.h"
#include "client/grpc_durable_stub.h"
#include "client/grpc_status.h"
#include "client/job_messages.h"
#include "client/labels_call.h"
#include "client/skeleton_reading.h"
#include "client/skeletonize_client.h"
#include "client/upload_call.h"
#include "core/exec/status_macros.h"
#include "proto/wire/options.h"
#include "proto/wire/result.h"
#include "proto/wire/shell_points.h"

// The only file in which the client's calls use gRPC's channels.

namespace bccskel::client {
namespace {

v1::SkeletonizeRequest ConfigRequest(const EncodedVolume& volume, const CallOptions& options) {
  v1::SkeletonizeRequest request;
  v1::SkeletonizeConfig& config = *request.mutable_config();
  *config.mutable_volume() = DeclarationOf(volume);
  *config.mutable_options() = wire::ToMessage(options.skeletonize);
  config.set_thin_volume_return(ToMessage(options.thin_volume));
  config.set_shell_points_return(options.on_shell_points ? v1::SHELL_POINTS_RETURN_ALL
                                                         : v1::SHELL_POINTS_RETURN_OMIT);
  config.set_threads(options.threads);
  return request;
}

// One attempt at a Skeletonize call.
class SkeletonizeCall final : private UploadCall<v1::SkeletonizeRequest, v1::SkeletonizeResponse> {
 public:
  SkeletonizeCall(grpc::ClientContext& context, Stream& stream, const CallOptions& options)
      : UploadCall(context, stream), options_(options) {}

  absl::StatusOr<SkeletonizeResult> Run(const EncodedVolume& volume) {
    BCCSKEL_RETURN_IF_ERROR(Converse(ConfigRequest(volume, options_), volume.bytes));
    if (reading_.summary().has_value()) TellTimes(*reading_.summary());
    if (options_.thin_volume == ThinVolume::kReturn && !reading_.has_thin_volume()) {
      return absl::DataLossError("the thinned volume is missing");
    }
    return std::move(reading_).Finish();
  }

  using UploadCall::accepted;

 private:
  absl::Status Take(v1::SkeletonizeResponse& response) override {
    switch (response.response_case()) {
      case v1::SkeletonizeResponse::kShellProgress:
        if (options_.on_shell) options_.on_shell(wire::FromMessage(response.shell_progress()));
        return absl::OkStatus();
      case v1::SkeletonizeResponse::kShellPoints:
        return TakeShellPoints(response.shell_points());
      case v1::SkeletonizeResponse::kSkeletonChunk:
        if (!first_chunk_at_.has_value()) first_chunk_at_ = Clock::now();
        return reading_.Add(response.skeleton_chunk());
      case v1::SkeletonizeResponse::kThinVolumeChunk:
        return reading_.Add(response.thin_volume_chunk());
      case v1::SkeletonizeResponse::kSummary:
        return reading_.Add(std::move(*response.mutable_summary()));
      case v1::SkeletonizeResponse::kAccepted:
        return absl::DataLossError("the server accepted the job twice");
      case v1::SkeletonizeResponse::RESPONSE_NOT_SET:
        return absl::OkStatus();  // a kind of event that this version does not know
    }
    return absl::OkStatus();
  }

  absl::Status TakeShellPoints(const v1::ShellPoints& message) const {
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<LatticePoint> points, wire::PointsOf(message));
    if (options_.on_shell_points) options_.on_shell_points(message.shell(), points);
    return absl::OkStatus();
  }

  void TellTimes(const v1::SkeletonSummary& summary) const {
    if (!options_.on_times) return;
    const wire::JobFacts facts = wire::FactsOf(summary);
    const Clock::time_point now = Clock::now();
    options_.on_times({.upload = UploadTime(),
                       .queue = facts.queued,
                       .decode = facts.decoded,
                       .download = now - first_chunk_at_.value_or(now)});
  }

  const CallOptions& options_;
  SkeletonReading reading_;
  std::optional<Clock::time_point> first_chunk_at_;
};

class GrpcStub : public Stub {
 public:
  explicit GrpcStub(std::shared_ptr<grpc::Channel> channel)
      : channel_(channel),
        skeletonization_(v1::SkeletonizationService::NewStub(channel)),
        server_(v1::ServerService::NewStub(channel)) {}

  absl::StatusOr<SkeletonizeResult> Skeletonize(const EncodedVolume& volume,
                                                const CallOptions& options,
                                                Clock::time_point deadline) override {
    AcceptedCall accepted;
    auto result = Attempt(*channel_, {options.stop, deadline}, [&](grpc::ClientContext& context) {
      const auto stream = skeletonization_->Skeletonize(&context);
      SkeletonizeCall call(context, *stream, options);
      auto one_stream = call.Run(volume);
      accepted = call.accepted();
      return one_stream;
    });
    if (result.ok() || accepted.job.empty()) return result;
    return AfterStream(result.status(), accepted, volume, options, deadline);
  }

  absl::StatusOr<LabelsReport> SkeletonizeLabels(const EncodedLabels& volume,
                                                 const LabelsCallOptions& options,
                                                 const LabelConsumer& consume,
                                                 Clock::time_point deadline) override {
    return Attempt(*channel_, {options.stop, deadline}, [&](grpc::ClientContext& context) {
      const auto stream = skeletonization_->SkeletonizeLabels(&context);
      return LabelsCall(context, *stream, options, consume).Run(volume);
    });
  }

  absl::StatusOr<ServerDescription> Describe(Clock::time_point deadline) override {
    v1::GetCapabilitiesResponse response;
    BCCSKEL_RETURN_IF_ERROR(Attempt(*channel_, {{}, deadline}, [&](grpc::ClientContext& context) {
      return FromGrpcStatus(server_->GetCapabilities(&context, {}, &response));
    }));
    return ServerDescription{response.server_version(), response.algorithm_version()};
  }

 private:
  // The stream has ended but the job continues: resumes it, or cancels it if nobody waits any more.
  absl::StatusOr<SkeletonizeResult> AfterStream(const absl::Status& error,
                                                const AcceptedCall& accepted,
                                                const EncodedVolume& volume,
                                                const CallOptions& options,
                                                Clock::time_point deadline) {
    DurableClient client(MakeDurableStub(channel_), kOutlastRestart);
    if (absl::IsUnavailable(error)) {
      if (options.on_lost) options.on_lost(accepted.job);
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
      return Resume(client, accepted, volume, options, left);
    }
    if (absl::IsCancelled(error) || absl::IsDeadlineExceeded(error)) {
      constexpr std::chrono::seconds kFarewell(5);
      // If this fails, the job ends by itself.
      client.CancelJob(accepted.job, {.timeout = kFarewell, .stop = {}}).status().IgnoreError();
    }
    return error;
  }

  // Sends the rest of the volume, waits for the job and reads its result: computes nothing twice.
  static absl::StatusOr<SkeletonizeResult> Resume(DurableClient& client,
                                                  const AcceptedCall& accepted,
                                                  const EncodedVolume& volume,
                                                  const CallOptions& options,
                                                  std::chrono::milliseconds timeout) {
    const DurableClient::Calls calls = {.timeout = timeout, .stop = options.stop};
    BCCSKEL_RETURN_IF_ERROR(client.FinishUpload(accepted.upload, volume, calls).status());
    BCCSKEL_RETURN_IF_ERROR(client.Await(accepted.job, options.on_shell, calls));
    return client.Fetch(accepted.job, calls);
  }

  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::SkeletonizationService::StubInterface> skeletonization_;
  std::unique_ptr<v1::ServerService::StubInterface> server_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<Stub>> MakeGrpcStub(const Endpoint& endpoint) {
  BCCSKEL_ASSIGN_OR_RETURN(std::shared_ptr<grpc::Channel> channel, OpenChannel(endpoint));
  return std::make_unique<GrpcStub>(std::move(channel));
}

std::unique_ptr<Stub> MakeGrpcStub(const std::string& address) {
  Endpoint endpoint;
  endpoint.address = address;
  return *MakeGrpcStub(endpoint);  // without secrets CheckEndpoint() refuses nothing
}

}  // namespace bccskel::client
