#ifndef BCCSKEL_CLIENT_SKELETON_READING_H_
#define BCCSKEL_CLIENT_SKELETON_READING_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "bccskel/v1/job_service.pb.h"
#include "core/pipeline/skeletonize.h"
#include "proto/wire/skeleton_chunks.h"

namespace bccskel::client {

// Assembles a result from its pieces.
class SkeletonReading {
 public:
  // Errors: DATA_LOSS for damaged, repeated or misplaced pieces.
  absl::Status Add(const v1::SkeletonChunk& chunk);
  absl::Status Add(const v1::ThinVolumeChunk& chunk);
  absl::Status Add(v1::SkeletonSummary summary);
  // Adds whichever piece it holds; moves the summary out of `piece`.
  absl::Status Add(v1::ReadSkeletonResponse& piece);

  // The number of pieces so far, which is the index of the next one.
  uint32_t pieces() const { return pieces_; }
  bool has_thin_volume() const { return !thin_bytes_.empty(); }
  const std::optional<v1::SkeletonSummary>& summary() const { return summary_; }

  // Errors: DATA_LOSS if the summary is missing or contradicts the result.
  absl::StatusOr<SkeletonizeResult> Finish() &&;

 private:
  uint32_t pieces_ = 0;
  wire::SkeletonAssembler assembler_;
  std::string thin_bytes_;
  std::optional<v1::SkeletonSummary> summary_;
};

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_SKELETON_READING_H_
