#ifndef BCCSKEL_CORE_IO_PLANES_WRITER_H_
#define BCCSKEL_CORE_IO_PLANES_WRITER_H_

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "core/io/byte_sink.h"
#include "core/io/volume_header.h"
#include "core/volume/volume.h"

namespace bccskel {

// Writes the bit planes of both sublattices, a row of bricks at a time.
// Needs:  compression kNone or kZstd; a dense size within the caller's limit.
// Errors: the sink's; CANCELLED or DEADLINE_EXCEEDED.
absl::Status WritePlanes(const Volume& volume, VolumeCompression compression, ByteSink& sink,
                         const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_PLANES_WRITER_H_
