#ifndef BCCSKEL_SERVER_JOBS_VOLUME_INTAKE_H_
#define BCCSKEL_SERVER_JOBS_VOLUME_INTAKE_H_

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/digest/sha256.h"
#include "core/exec/context.h"
#include "core/io/volume_decoder.h"
#include "server/jobs/upload_digest.h"

namespace bccskel::server {

// Takes in the bytes of a declared volume: digests them, holds the volume's own header against the
// declaration, decodes.
// Threads: one at a time.
class VolumeIntake {
 public:
  using MakeDecoder = std::function<absl::StatusOr<std::unique_ptr<VolumeDecoder>>(
      const VolumeHeader& header, const VolumeLimits& limits)>;

  // Needs: `declared` completed under `limits`.
  VolumeIntake(const VolumeHeader& declared, uint64_t size_bytes, const VolumeLimits& limits,
               MakeDecoder make_decoder = &MakeVolumeDecoder);

  // Needs: no more than `size_bytes` in all.
  // Errors: INVALID_ARGUMENT for bytes that are malformed or not what was declared;
  //         RESOURCE_EXHAUSTED for a volume over the limits.
  absl::Status Append(std::string_view bytes);

  // Errors: as Append(); INVALID_ARGUMENT for another digest than `expected`; CANCELLED,
  //         DEADLINE_EXCEEDED.
  absl::StatusOr<Volume> Finish(const std::optional<Sha256Digest>& expected,
                                const exec::Context& context);

  // Of a cubic mask, what was counted on its own grid; known after Finish().
  std::optional<BettiNumbers> mask_topology() const { return decoder_->mask_topology(); }

 private:
  absl::Status Decode(std::string_view bytes);
  absl::Status StartDecoder(std::string_view front);
  absl::Status AsCallersError(absl::Status status) const;

  const VolumeHeader declared_;
  const uint64_t size_bytes_;
  const MakeDecoder make_decoder_;
  VolumeLimits limits_;
  UploadDigest digest_;
  std::string front_;  // until the header is complete
  std::unique_ptr<VolumeDecoder> decoder_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_VOLUME_INTAKE_H_
