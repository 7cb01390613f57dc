#ifndef BCCSKEL_SERVER_CALLS_LABELS_STREAM_H_
#define BCCSKEL_SERVER_CALLS_LABELS_STREAM_H_

#include <utility>

#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "proto/wire/labels.h"
#include "server/calls/labels_outbox.h"
#include "server/calls/labels_request.h"
#include "server/calls/volume_stream.h"

namespace bccskel::server {

struct LabelsCall {
  using Request = v1::SkeletonizeLabelsRequest;
  using Response = v1::SkeletonizeLabelsResponse;
  using Listener = LabelsListener;
  using Result = LabelsResult;
  using Outbox = LabelsOutbox;
  static absl::StatusOr<LabelsRequest> JobRequestOf(const v1::SkeletonizeLabelsConfig& config,
                                                    const VolumeLimits& limits) {
    return LabelsRequestOf(config, limits);
  }
};

// A SkeletonizeLabels call.
class LabelsStream final : public VolumeStream<LabelsCall> {
 public:
  using VolumeStream::VolumeStream;
  void OnProgress(uint64_t done, uint64_t total, std::chrono::nanoseconds elapsed) override {
    Report(wire::ToMessage(wire::LabelProgress{.done = done, .total = total}, elapsed), elapsed);
  }
  void OnLabel(LabelResult result) override {
    Send([&](LabelsOutbox& outbox) { outbox.Add(std::move(result)); });
  }
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_LABELS_STREAM_H_
