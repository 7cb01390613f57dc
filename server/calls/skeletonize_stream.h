#ifndef BCCSKEL_SERVER_CALLS_SKELETONIZE_STREAM_H_
#define BCCSKEL_SERVER_CALLS_SKELETONIZE_STREAM_H_

#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "proto/wire/result.h"
#include "proto/wire/shell_points.h"
#include "server/calls/job_request.h"
#include "server/calls/response_outbox.h"
#include "server/calls/volume_stream.h"

namespace bccskel::server {

struct SkeletonizeCall {
  using Request = v1::SkeletonizeRequest;
  using Response = v1::SkeletonizeResponse;
  using Listener = JobListener;
  using Result = JobResult;
  using Outbox = ResponseOutbox;
  static absl::StatusOr<JobRequest> JobRequestOf(const v1::SkeletonizeConfig& config,
                                                 const VolumeLimits& limits) {
    return server::JobRequestOf(config, limits);
  }
};

// A Skeletonize call whose job lives in memory.
class SkeletonizeStream : public VolumeStream<SkeletonizeCall> {
 public:
  using VolumeStream::VolumeStream;
  void OnShell(const exec::ShellProgress& progress, std::chrono::nanoseconds elapsed) override {
    Report(wire::ToMessage(progress, elapsed), elapsed);
  }
  uint64_t OnShellPoints(int32_t shell, const Volume& points) override {
    uint64_t bytes = 0;
    for (const v1::ShellPoints& message : wire::ShellPointsMessages(shell, points)) {
      std::string serialized = message.SerializeAsString();
      bytes += serialized.size();
      Send([&](ResponseOutbox& outbox) { outbox.Peel(std::move(serialized)); });
    }
    return bytes;
  }
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_SKELETONIZE_STREAM_H_
