#include "client/encoded_volume.h"

#include "core/exec/context.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_encoder.h"

namespace bccskel::client {
namespace {

// Coordinates and bits of a brick.
constexpr uint64_t kBrickBytes = 8 + sizeof(BrickBits);

// Compressions for sending: fast, and small enough.
VolumeCompression WireCompression(VolumeEncoding encoding) {
  if (encoding == VolumeEncoding::kRawPlanes) return VolumeCompression::kNone;
  return encoding == VolumeEncoding::kOpenExr ? VolumeCompression::kRle : VolumeCompression::kZstd;
}

}  // namespace

VolumeEncoding BestEncodingOf(const Volume& volume) {
  const uint64_t bricks_bytes = volume.brick_count() * kBrickBytes;
  return bricks_bytes <= DensePlaneBytes(volume.extent()) ? VolumeEncoding::kBricks
                                                          : VolumeEncoding::kOpenExr;
}

absl::StatusOr<EncodedVolume> EncodeForSending(const Volume& volume, VolumeEncoding encoding,
                                               const std::stop_token& stop) {
  exec::Context context;
  context.stop = stop;
  EncodedVolume encoded;
  encoded.encoding = encoding;
  encoded.extent = volume.extent();
  encoded.placement = volume.placement();
  encoded.bricks = volume.brick_count();
  const EncodeVolumeOptions options = {.encoding = encoding,
                                       .compression = WireCompression(encoding)};
  BCCSKEL_ASSIGN_OR_RETURN(encoded.bytes, EncodeVolume(volume, options, context));
  return encoded;
}

}  // namespace bccskel::client
