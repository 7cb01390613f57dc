#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "bccskel/v1/server_service.grpc.pb.h"
#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "client/connection.h"
#include "client/grpc_status.h"
#include "core/digest/sha256.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_decoder.h"
#include "proto/wire/options.h"
#include "proto/wire/placement.h"
#include "proto/wire/result.h"
#include "proto/wire/skeleton_chunks.h"

// The only file of the client that speaks gRPC.

namespace bccskel::client {
namespace {

using SkeletonizeStream =
    grpc::ClientReaderWriterInterface<v1::SkeletonizeRequest, v1::SkeletonizeResponse>;

constexpr size_t kChunkBytes = 512 * 1024;

v1::VolumeEncoding ToMessage(VolumeEncoding encoding) {
  switch (encoding) {
    case VolumeEncoding::kOpenExr:
      return v1::VOLUME_ENCODING_OPENEXR;
    case VolumeEncoding::kRawPlanes:
      return v1::VOLUME_ENCODING_RAW_PLANES;
    case VolumeEncoding::kBricks:
      return v1::VOLUME_ENCODING_BRICKS;
    case VolumeEncoding::kCubicMask:
      return v1::VOLUME_ENCODING_CUBIC_MASK;
  }
  return v1::VOLUME_ENCODING_UNSPECIFIED;  // not reached: the enumerators are exhausted above
}

v1::SkeletonizeRequest ConfigRequest(const EncodedVolume& volume, const CallOptions& options) {
  v1::SkeletonizeRequest request;
  v1::SkeletonizeConfig& config = *request.mutable_config();
  v1::VolumeDeclaration& declaration = *config.mutable_volume();
  declaration.set_encoding(ToMessage(volume.encoding));
  *declaration.mutable_extent() = wire::ToMessage(volume.extent);
  declaration.set_size_bytes(volume.bytes.size());
  declaration.set_max_bricks(volume.bricks);
  *config.mutable_options() = wire::ToMessage(options.skeletonize);
  config.set_thin_volume_return(options.thin_volume == ThinVolume::kReturn
                                    ? v1::THIN_VOLUME_RETURN_BRICKS
                                    : v1::THIN_VOLUME_RETURN_OMIT);
  config.set_threads(options.threads);
  return request;
}

// One Skeletonize call from its first to its last message, on the calling thread.
class SkeletonizeCall {
 public:
  SkeletonizeCall(grpc::ClientContext& context, SkeletonizeStream& stream,
                  const EncodedVolume& volume, const CallOptions& options)
      : context_(context), stream_(stream), volume_(volume), options_(options) {}

  absl::StatusOr<SkeletonizeResult> Run() {
    // A write that fails means that the call has ended; Finish() knows why.
    const bool sent = stream_.Write(ConfigRequest(volume_, options_)) && ReadAccepted() &&
                      SendVolume() && stream_.WritesDone();
    if (sent) ReadReplies();
    const grpc::Status ended = stream_.Finish();
    BCCSKEL_RETURN_IF_ERROR(reply_error_);
    if (!ended.ok()) return FromGrpcStatus(ended);
    if (!summary_.has_value()) return absl::DataLossError("the server ended without a summary");
    return Assemble();
  }

 private:
  bool ReadAccepted() {
    v1::SkeletonizeResponse response;
    if (!stream_.Read(&response)) return false;
    if (!response.has_accepted()) {
      reply_error_ = absl::DataLossError("the server's first reply does not accept the job");
      context_.TryCancel();  // such a server may wait for the volume until the deadline
      return false;
    }
    chunk_bytes_ = std::min<size_t>(kChunkBytes, response.accepted().max_chunk_bytes());
    return true;
  }

  bool SendVolume() {
    v1::SkeletonizeRequest request;
    const std::string& bytes = volume_.bytes;
    for (size_t offset = 0; offset < bytes.size() && chunk_bytes_ > 0; offset += chunk_bytes_) {
      request.mutable_chunk()->set_offset(offset);
      request.mutable_chunk()->set_data(bytes.substr(offset, chunk_bytes_));
      if (!stream_.Write(request)) return false;
    }
    const Sha256Digest digest = Sha256Of(bytes);
    request.mutable_finish()->set_size_bytes(bytes.size());
    request.mutable_finish()->set_sha256(digest.bytes.data(), digest.bytes.size());
    return stream_.Write(request);
  }

  void ReadReplies() {
    v1::SkeletonizeResponse response;
    while (stream_.Read(&response)) {
      // The rest is read all the same, so that the server can end the call.
      if (reply_error_.ok()) reply_error_ = Take(response);
    }
  }

  absl::Status Take(v1::SkeletonizeResponse& response) {
    switch (response.response_case()) {
      case v1::SkeletonizeResponse::kShellProgress:
        if (options_.on_shell) options_.on_shell(wire::FromMessage(response.shell_progress()));
        return absl::OkStatus();
      case v1::SkeletonizeResponse::kSkeletonChunk:
        return assembler_.Add(response.skeleton_chunk());
      case v1::SkeletonizeResponse::kThinVolumeChunk:
        return TakeThinVolume(response.thin_volume_chunk());
      case v1::SkeletonizeResponse::kSummary:
        summary_ = std::move(*response.mutable_summary());
        return absl::OkStatus();
      case v1::SkeletonizeResponse::kAccepted:
        return absl::DataLossError("the server accepted the job twice");
      case v1::SkeletonizeResponse::RESPONSE_NOT_SET:
        return absl::OkStatus();  // a kind of event that this version does not know
    }
    return absl::OkStatus();
  }

  absl::Status TakeThinVolume(const v1::ThinVolumeChunk& chunk) {
    if (chunk.offset() != thin_bytes_.size()) {
      return absl::DataLossError("a piece of the thinned volume is missing");
    }
    thin_bytes_ += chunk.data();
    return absl::OkStatus();
  }

  absl::StatusOr<SkeletonizeResult> Assemble() {
    BCCSKEL_ASSIGN_OR_RETURN(SkeletonizeResult result, std::move(assembler_).Finish(*summary_));
    if (options_.thin_volume == ThinVolume::kReturn) {
      absl::StatusOr<Volume> thin = DecodeVolume(VolumeEncoding::kBricks, thin_bytes_);
      if (!thin.ok()) {
        return absl::DataLossError("the thinned volume is damaged: " +
                                   std::string(thin.status().message()));
      }
      result.thin = *std::move(thin);
    }
    return result;
  }

  grpc::ClientContext& context_;
  SkeletonizeStream& stream_;
  const EncodedVolume& volume_;
  const CallOptions& options_;
  size_t chunk_bytes_ = kChunkBytes;
  wire::SkeletonAssembler assembler_;
  std::string thin_bytes_;
  std::optional<v1::SkeletonSummary> summary_;
  absl::Status reply_error_;
};

class GrpcStub : public Stub {
 public:
  explicit GrpcStub(std::shared_ptr<grpc::Channel> channel)
      : skeletonization_(v1::SkeletonizationService::NewStub(channel)),
        server_(v1::ServerService::NewStub(channel)) {}

  absl::StatusOr<SkeletonizeResult> Skeletonize(const EncodedVolume& volume,
                                                const CallOptions& options,
                                                Clock::time_point deadline) override {
    if (options.stop.stop_requested()) return absl::CancelledError("cancelled by the caller");
    grpc::ClientContext context;
    context.set_deadline(deadline);
    const std::stop_callback cancel(options.stop, [&context] { context.TryCancel(); });
    const auto stream = skeletonization_->Skeletonize(&context);
    return SkeletonizeCall(context, *stream, volume, options).Run();
  }

  absl::StatusOr<ServerDescription> Describe(Clock::time_point deadline) override {
    grpc::ClientContext context;
    context.set_deadline(deadline);
    v1::GetCapabilitiesResponse response;
    const grpc::Status status = server_->GetCapabilities(&context, {}, &response);
    if (!status.ok()) return FromGrpcStatus(status);
    return ServerDescription{response.server_version(), response.algorithm_version()};
  }

 private:
  std::unique_ptr<v1::SkeletonizationService::StubInterface> skeletonization_;
  std::unique_ptr<v1::ServerService::StubInterface> server_;
};

}  // namespace

std::unique_ptr<Stub> MakeGrpcStub(const std::string& address) {
  grpc::ChannelArguments arguments;
  // The retry loop sets the pace; gRPC's own pause after a refused connection must not exceed it.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 2000);
  // Retries are counted in one place.
  arguments.SetInt(GRPC_ARG_ENABLE_RETRIES, 0);
  return std::make_unique<GrpcStub>(
      grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments));
}

}  // namespace bccskel::client
