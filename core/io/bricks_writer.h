#ifndef BCCSKEL_CORE_IO_BRICKS_WRITER_H_
#define BCCSKEL_CORE_IO_BRICKS_WRITER_H_

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "core/io/byte_sink.h"
#include "core/io/volume_header.h"
#include "core/volume/volume.h"

namespace bccskel {

// Writes header and records in brick order: without compression these bytes are canonical, and
// VolumeDigest() is their digest.
// Needs:  compression kNone or kZstd.
// Errors: the sink's; CANCELLED or DEADLINE_EXCEEDED.
absl::Status WriteBricks(const Volume& volume, VolumeCompression compression, ByteSink& sink,
                         const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_BRICKS_WRITER_H_
