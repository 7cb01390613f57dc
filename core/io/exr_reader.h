#ifndef BCCSKEL_CORE_IO_EXR_READER_H_
#define BCCSKEL_CORE_IO_EXR_READER_H_

#include <cstddef>
#include <span>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/io/volume_header.h"
#include "core/volume/volume.h"

namespace bccskel {

// Reads a whole OpenEXR volume, chunk by chunk, straight into bricks.
// Errors: as ScanVolumeHeader(), BrickCollector and Context::StopStatus().
absl::StatusOr<Volume> ReadExr(std::span<const std::byte> file, const VolumeLimits& limits,
                               const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_EXR_READER_H_
