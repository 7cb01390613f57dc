#ifndef BCCSKEL_SERVER_JOBS_VOLUME_RECEIVER_H_
#define BCCSKEL_SERVER_JOBS_VOLUME_RECEIVER_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/digest/sha256.h"
#include "core/exec/context.h"
#include "core/io/encoded_body.h"
#include "core/io/volume_decoder.h"
#include "core/labels/label_collector.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// Errors: INVALID_ARGUMENT if the sender of a chunk states another CRC-32C than that of its bytes.
absl::Status CheckChunk(const std::string& bytes, std::optional<uint32_t> crc32c);

// Receives the bytes of a declared volume: computes their digest, compares the volume's own header
// with the declaration, and decodes.
// Threads: one at a time.
class VolumeReceiver {
 public:
  using MakeDecoder = std::function<absl::StatusOr<std::unique_ptr<VolumeDecoder>>(
      const VolumeHeader& header, const VolumeLimits& limits)>;

  // Needs: `declared` was completed under `limits`.
  VolumeReceiver(const VolumeHeader& declared, uint64_t size_bytes, const VolumeLimits& limits,
                 MakeDecoder make_decoder = &MakeVolumeDecoder);

  // Needs: at most `size_bytes` in all.
  // Errors: INVALID_ARGUMENT for bytes that are malformed or differ from the declaration;
  //         RESOURCE_EXHAUSTED for a volume over the limits.
  absl::Status Append(std::string_view bytes);

  // Errors: as Append(); INVALID_ARGUMENT for a digest other than `expected`; CANCELLED,
  //         DEADLINE_EXCEEDED.
  absl::StatusOr<Volume> Finish(const std::optional<Sha256Digest>& expected,
                                const exec::Context& context);

  // The topology of a cubic mask, counted on its own grid; known after Finish().
  std::optional<BettiNumbers> mask_topology() const { return decoder_->mask_topology(); }

 private:
  absl::Status Decode(std::string_view bytes);
  absl::Status StartDecoder(std::string_view front);
  absl::Status AsCallersError(absl::Status status) const;

  const VolumeHeader declared_;
  const uint64_t size_bytes_;
  const MakeDecoder make_decoder_;
  VolumeLimits limits_;
  Sha256 digest_;
  std::string front_;  // until the header is complete
  std::unique_ptr<VolumeDecoder> decoder_;
};

struct CollectedLabels {
  LabeledObjects objects;
  uint64_t skipped = 0;  // too small
  uint64_t absent = 0;   // requested, but without a voxel
};

// Receives the bytes of a declared volume of labels, one slice at a time, and keeps the runs of the
// requested labels.
// Threads: one at a time.
class LabelReceiver {
 public:
  // Needs: `request` outlives the receiver.
  explicit LabelReceiver(const LabelsRequest& request);

  // Errors: INVALID_ARGUMENT for bytes that are malformed, too many or different from the
  //         declaration; CANCELLED, DEADLINE_EXCEEDED.
  absl::Status Append(std::string_view bytes, const exec::Context& context);
  // Called once. Errors: as Append(); INVALID_ARGUMENT for missing bytes and for a digest other
  // than `expected`.
  absl::StatusOr<CollectedLabels> Finish(const std::optional<Sha256Digest>& expected,
                                         const exec::Context& context);

 private:
  absl::Status Start();
  absl::Status AddBytes(std::span<const std::byte> bytes, const exec::Context& context);
  absl::Status AddSlice(const exec::Context& context);
  absl::Status CheckPromises(const LabeledObjects& objects) const;

  const LabelsRequest& request_;
  const LabelVolumeHeader& header_;
  Sha256 digest_;
  std::optional<BodyReader> body_;  // allocated with the first bytes
  std::optional<LabelCollector> collector_;
  std::vector<std::byte> slice_;  // the part of the next slice that has arrived
  size_t filled_bytes_ = 0;
  std::vector<uint64_t> labels_;
  uint64_t received_bytes_ = 0;  // after decompression
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_VOLUME_RECEIVER_H_
