#ifndef BCCSKEL_PROTO_WIRE_RESULT_H_
#define BCCSKEL_PROTO_WIRE_RESULT_H_

#include <chrono>
#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "bccskel/v1/skeleton.pb.h"
#include "bccskel/v1/skeletonization_service.pb.h"
#include "core/certificate/certificate.h"
#include "core/exec/context.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel::wire {

v1::Certificate ToMessage(const Certificate& certificate);
Certificate FromMessage(const v1::Certificate& message);

// `elapsed` is the time since the job's computation began.
v1::ShellProgress ToMessage(const exec::ShellProgress& progress, std::chrono::nanoseconds elapsed);
exec::ShellProgress FromMessage(const v1::ShellProgress& message);

// Facts about a job that the pipeline does not know.
struct JobFacts {
  std::chrono::nanoseconds queued{0};
  std::chrono::nanoseconds decoded{0};
  int32_t threads = 1;
  uint64_t thin_volume_size_bytes = 0;
  std::string algorithm_version;
  std::string method;

  friend bool operator==(const JobFacts&, const JobFacts&) = default;
};

v1::SkeletonSummary SummaryOf(const SkeletonizeResult& result, const JobFacts& facts);
JobFacts FactsOf(const v1::SkeletonSummary& message);

// The summary's content, without graph and thin volume.
// Errors: DATA_LOSS for an invalid summary (a digest that is not 32 bytes long).
absl::StatusOr<SkeletonizeResult> FromMessage(const v1::SkeletonSummary& message);

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_RESULT_H_
