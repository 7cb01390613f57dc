#ifndef BCCSKEL_CLIENT_ENCODED_VOLUME_H_
#define BCCSKEL_CLIENT_ENCODED_VOLUME_H_

#include <cstdint>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "core/io/volume_header.h"
#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"

namespace bccskel::client {

// A volume ready to be sent.
struct EncodedVolume {
  VolumeEncoding encoding = VolumeEncoding::kBricks;
  LatticeExtent extent;
  Placement placement;
  uint64_t bricks = 0;  // occupied ones
  std::string bytes;
};

// The encoding that is smaller before compression: bricks if the object fills little of its box,
// OpenEXR if it fills most of it.
VolumeEncoding BestEncodingOf(const Volume& volume);

// Errors: INVALID_ARGUMENT, CANCELLED, and those of the encoder's library.
// Needs:  kBricks, kOpenExr or kRawPlanes; the last does not store the placement.
absl::StatusOr<EncodedVolume> EncodeForSending(const Volume& volume, VolumeEncoding encoding,
                                               const std::stop_token& stop);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_ENCODED_VOLUME_H_
