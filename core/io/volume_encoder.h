#ifndef BCCSKEL_CORE_IO_VOLUME_ENCODER_H_
#define BCCSKEL_CORE_IO_VOLUME_ENCODER_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/io/byte_sink.h"
#include "core/io/volume_header.h"
#include "core/volume/volume.h"

namespace bccskel {

struct EncodeVolumeOptions {
  VolumeEncoding encoding = VolumeEncoding::kOpenExr;
  VolumeCompression compression = VolumeCompression::kRle;  // the fast one, for the wire
  // A box beyond this is not written densely (OpenEXR, planes), however few points it has.
  uint64_t max_dense_bytes = uint64_t{4} << 30;
};

// Encodes into memory. Memory: the encoded bytes and a strip, never the box.
// Errors: INVALID_ARGUMENT for a volume without extent, a box over max_dense_bytes, a box that
//         OpenEXR cannot hold, or a compression that the encoding does not have; each names the
//         bricks encoding where that is the way out. CANCELLED or DEADLINE_EXCEEDED.
absl::StatusOr<std::string> EncodeVolume(const Volume& volume,
                                         const EncodeVolumeOptions& options = {},
                                         const exec::Context& context = {});

// The same into a sink. Errors: the sink's, too; what it holds then is not a volume.
absl::Status EncodeVolumeTo(const Volume& volume, const EncodeVolumeOptions& options,
                            ByteSink& sink, const exec::Context& context = {});

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_VOLUME_ENCODER_H_
