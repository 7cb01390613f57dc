#ifndef BCCSKEL_CORE_IO_VOLUME_FILE_H_
#define BCCSKEL_CORE_IO_VOLUME_FILE_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/io/volume_header.h"
#include "core/volume/layer_part.h"
#include "core/volume/volume.h"

namespace bccskel {

// Reads a volume file, OpenEXR or bricks; the first bytes decide which, not the name.
// Errors: as ScanVolumeHeader() and VolumeDecoder; NOT_FOUND, PERMISSION_DENIED or another code for
//         what the system says. Every message begins with the path.
absl::StatusOr<Volume> ReadVolumeFile(const std::string& path, const VolumeLimits& limits = {},
                                      const exec::Context& context = {});

// One of several readers' share of a volume file: each brick comes to one of them, which one
// depends on the encoding. Plain bricks are read where the share lies in the file. Bricks in a zstd
// frame are decoded by all, each of whom keeps the bricks of its layers. An OpenEXR file is decoded
// as a whole, and by the first reader only. Errors: as ReadVolumeFile(); a brick that is given
// twice only where both come to the same reader.
absl::StatusOr<Volume> ReadVolumePart(const std::string& path, const LayerPart& part,
                                      const VolumeLimits& limits = {},
                                      const exec::Context& context = {});

// Writes a volume file: .exr is OpenEXR with ZIP, .bccb bricks with zstd. A reader of `path` sees
// the old file or the whole new one, never a part; after an error the old file is still there.
// Errors: INVALID_ARGUMENT for a name with another ending, and as EncodeVolume(); what the system
//         says.
absl::Status WriteVolumeFile(const std::string& path, const Volume& volume,
                             const exec::Context& context = {});

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_VOLUME_FILE_H_
