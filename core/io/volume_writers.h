#ifndef BCCSKEL_CORE_IO_VOLUME_WRITERS_H_
#define BCCSKEL_CORE_IO_VOLUME_WRITERS_H_

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "core/io/byte_sink.h"
#include "core/io/volume_header.h"
#include "core/volume/volume.h"

namespace bccskel {

// The writers of the encodings; volume_encoder.h chooses between them.
// Needs:  a grid that CheckGrid() takes, a compression that CheckCompression() takes for the
//         encoding, and of the dense ones a size within the caller's limit.
// Errors: the sink's; CANCELLED or DEADLINE_EXCEEDED.

// A two-part OpenEXR file, one chunk of scan lines at a time. Errors: also INVALID_ARGUMENT as
// CheckExrCanHold().
absl::Status WriteExr(const Volume& volume, VolumeCompression compression, ByteSink& sink,
                      const exec::Context& context);
// The bit planes of both sublattices, a row of bricks at a time.
absl::Status WritePlanes(const Volume& volume, VolumeCompression compression, ByteSink& sink,
                         const exec::Context& context);
// Header and records in brick order: without compression these bytes are canonical, and
// VolumeDigest() is their digest.
absl::Status WriteBricks(const Volume& volume, VolumeCompression compression, ByteSink& sink,
                         const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_VOLUME_WRITERS_H_
