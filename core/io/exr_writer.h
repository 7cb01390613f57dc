#ifndef BCCSKEL_CORE_IO_EXR_WRITER_H_
#define BCCSKEL_CORE_IO_EXR_WRITER_H_

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "core/io/byte_sink.h"
#include "core/io/volume_header.h"
#include "core/volume/volume.h"

namespace bccskel {

// Writes a volume as a two-part OpenEXR file, one chunk of scan lines at a time.
// Needs:  a grid that CheckGrid() takes, a compression that CheckCompression() takes for OpenEXR.
// Errors: INVALID_ARGUMENT as CheckExrCanHold(); the sink's; CANCELLED or DEADLINE_EXCEEDED.
absl::Status WriteExr(const Volume& volume, VolumeCompression compression, ByteSink& sink,
                      const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_EXR_WRITER_H_
