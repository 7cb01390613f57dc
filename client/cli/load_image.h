#ifndef BCCSKEL_CLIENT_CLI_LOAD_IMAGE_H_
#define BCCSKEL_CLIENT_CLI_LOAD_IMAGE_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/image_arguments.h"
#include "client/export/world.h"
#include "core/certificate/certificate.h"
#include "core/exec/context.h"
#include "core/image/image_info.h"
#include "core/labels/voxel_runs.h"
#include "core/volume/volume.h"

namespace bccskel::cli {

// What an image was before it became an object.
struct ImageStage {
  ImageInfo info;
  uint64_t voxels = 0;  // of the foreground
  BettiNumbers mask;    // counted on the image's own grid
};

struct ImageObject {
  Volume volume;
  ImageStage image;
  std::optional<LabeledObjects> voxels = std::nullopt;  // of the object, as label 1; if wanted
};

enum class KeptVoxels : uint8_t { kNone, kAll };

// Reads an image slice by slice and converts its foreground.
// Errors: as OpenImage(), ForegroundOf() and MaskConverter; every message names the path.
absl::StatusOr<ImageObject> ConvertImageFile(const std::string& path,
                                             const ImageArguments& arguments, KeptVoxels kept,
                                             const exec::Context& context);

// What the image says of its world.
exporting::World WorldOf(const ImageInfo& info);

// OK where the object has the topology of the mask that it was made from. A sampling may change
// it, which is only said on standard error; the exact conversion may not.
// Errors: INTERNAL, says what changed.
absl::Status CheckConversion(const std::string& path, const ImageArguments& arguments,
                             const BettiNumbers& mask, const BettiNumbers& object);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_LOAD_IMAGE_H_
