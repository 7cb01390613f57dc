// Any bytes as what a caller sends on a stream: the first byte chooses the call, length-delimited
// requests follow. They go through the checks of order, declaration and options to a runner that
// decodes and computes nothing. Every answer is OK or the caller's error with its details, never
// UNKNOWN or INTERNAL.
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/delimited_message_util.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>

#include "bccskel/v1/rpc_details.pb.h"
#include "bccskel/v1/skeletonization_service.pb.h"
#include "core/exec/status_macros.h"
#include "core/pipeline/skeletonize.h"
#include "server/admission/memory_estimate.h"
#include "server/calls/request_sequence.h"
#include "server/calls/requests.h"
#include "server/calls/status_mapping.h"
#include "server/jobs/volume_receiver.h"

namespace bccskel::server {
namespace {

constexpr VolumeLimits kLimits = {
    .max_extent_cells = 1024, .max_bricks = 1 << 14, .max_decoded_bytes = 16 << 20};
constexpr uint64_t kMostBytes = uint64_t{64} << 20;

void Insist(bool holds) {
  if (!holds) std::abort();
}

void CheckOptions(const SkeletonizeOptions& options, int threads) {
  Insist(CheckSkeletonizeOptions(options).ok());
  Insist(threads >= 0);
}

// Takes in a volume as a job does. What would take much memory is refused, as by admission.
class VolumeCall {
 public:
  using Request = v1::SkeletonizeRequest;
  absl::Status Start(const v1::SkeletonizeConfig& config) {
    BCCSKEL_ASSIGN_OR_RETURN(request_, JobRequestOf(config, kLimits));
    CheckOptions(request_.options, request_.threads_wanted);
    Insist(request_.header.max_bricks <= kLimits.max_bricks);
    Insist(request_.size_bytes <= request_.header.max_encoded_bytes);
    if (BytesToSkeletonize(request_.header, request_.size_bytes) > 2 * kMostBytes) {
      return absl::ResourceExhaustedError("too much");
    }
    receiver_.emplace(request_.header, request_.size_bytes, kLimits);
    return absl::OkStatus();
  }
  absl::Status Append(std::string_view bytes) { return receiver_->Append(bytes); }
  absl::Status Finish() {
    const auto volume = receiver_->Finish(std::nullopt, {});
    if (!volume.ok()) return volume.status();
    Insist(volume->brick_count() <= request_.header.max_bricks);
    return absl::OkStatus();
  }

 private:
  JobRequest request_;
  std::optional<VolumeReceiver> receiver_;
};

class LabelsCall {
 public:
  using Request = v1::SkeletonizeLabelsRequest;
  absl::Status Start(const v1::SkeletonizeLabelsConfig& config) {
    BCCSKEL_ASSIGN_OR_RETURN(request_, JobRequestOf(config, kLimits));
    CheckOptions(request_.options, request_.threads_wanted);
    if (BytesToSkeletonizeLabels(request_.header, 1) > 2 * kMostBytes) {
      return absl::ResourceExhaustedError("too much");
    }
    receiver_.emplace(request_);
    return absl::OkStatus();
  }
  absl::Status Append(std::string_view bytes) { return receiver_->Append(bytes, {}); }
  absl::Status Finish() { return receiver_->Finish(std::nullopt, {}).status(); }

 private:
  LabelsRequest request_;
  std::optional<LabelReceiver> receiver_;
};

template <typename Call>
absl::Status Converse(google::protobuf::io::CodedInputStream& input) {
  Call call;
  RequestSequence sequence;
  typename Call::Request request;
  while (google::protobuf::util::ParseDelimitedFromCodedStream(&request, &input, nullptr)) {
    BCCSKEL_RETURN_IF_ERROR(sequence.Take(request));
    if (request.has_config()) BCCSKEL_RETURN_IF_ERROR(call.Start(request.config()));
    if (request.has_chunk()) BCCSKEL_RETURN_IF_ERROR(call.Append(request.chunk().data()));
    if (request.has_finish()) BCCSKEL_RETURN_IF_ERROR(call.Finish());
    request.Clear();
  }
  return sequence.HalfClose();
}

void CheckAnswer(const absl::Status& status) {
  const grpc::Status answer = ToGrpcStatus(status);
  if (answer.ok()) return;
  Insist(answer.error_code() == grpc::INVALID_ARGUMENT ||
         answer.error_code() == grpc::OUT_OF_RANGE ||
         answer.error_code() == grpc::RESOURCE_EXHAUSTED);
  v1::Status details;
  Insist(details.ParseFromString(answer.error_details()) && details.details_size() > 0);
}

}  // namespace
}  // namespace bccskel::server

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace bccskel::server;
  if (size == 0) return 0;
  google::protobuf::io::ArrayInputStream bytes(data + 1, static_cast<int>(size - 1));
  google::protobuf::io::CodedInputStream input(&bytes);
  CheckAnswer(data[0] % 2 == 0 ? Converse<VolumeCall>(input) : Converse<LabelsCall>(input));
  return 0;
}
