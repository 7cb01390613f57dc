#ifndef BCCSKEL_CORE_IO_VOLUME_DECODER_H_
#define BCCSKEL_CORE_IO_VOLUME_DECODER_H_

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/exec/context.h"
#include "core/io/volume_header.h"
#include "core/volume/volume.h"

namespace bccskel {

// Decodes a volume whose bytes come in order, in parts of any size. Planes and bricks are decoded
// as they arrive; an OpenEXR file is kept and decoded by Finish(). Memory stays within
// VolumeHeader::DecodingBytes(). After an error the decoder is of no further use.
// Threads: one at a time.
class VolumeDecoder {
 public:
  virtual ~VolumeDecoder() = default;

  // The next bytes of the encoding, its header included.
  // Errors: INVALID_ARGUMENT for bytes that are malformed or too many; RESOURCE_EXHAUSTED for more
  //         bricks than the limit.
  virtual absl::Status Append(std::span<const std::byte> bytes) = 0;

  // The volume, when all bytes have been appended. Call it once.
  // Errors: as Append(), and INVALID_ARGUMENT when bytes are missing; CANCELLED or
  //         DEADLINE_EXCEEDED as the context says.
  virtual absl::StatusOr<Volume> Finish(const exec::Context& context) = 0;
  absl::StatusOr<Volume> Finish() { return Finish(exec::Context()); }

  // Of a cubic mask, what was counted on its own grid; known after Finish().
  virtual std::optional<BettiNumbers> mask_topology() const { return std::nullopt; }
};

// `header` comes from ScanVolumeHeader() or CompleteVolumeHeader(); the decoder insists that the
// bytes have this very header.
// Errors: as CompleteVolumeHeader().
absl::StatusOr<std::unique_ptr<VolumeDecoder>> MakeVolumeDecoder(const VolumeHeader& header,
                                                                 const VolumeLimits& limits);

// A whole encoding that carries its header: OpenEXR or bricks.
// Errors: as ScanVolumeHeader() and VolumeDecoder.
absl::StatusOr<Volume> DecodeVolume(VolumeEncoding encoding, std::span<const std::byte> bytes,
                                    const VolumeLimits& limits = {},
                                    const exec::Context& context = {});
absl::StatusOr<Volume> DecodeVolume(VolumeEncoding encoding, std::string_view bytes,
                                    const VolumeLimits& limits = {},
                                    const exec::Context& context = {});

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_VOLUME_DECODER_H_
