#ifndef BCCSKEL_CLIENT_CLI_CONVERT_IMAGE_H_
#define BCCSKEL_CLIENT_CLI_CONVERT_IMAGE_H_

#include <cstdint>
#include <optional>

#include "absl/status/statusor.h"
#include "client/cli/image_arguments.h"
#include "core/certificate/certificate.h"
#include "core/exec/context.h"
#include "core/import/image/image_source.h"
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

// Reads an image slice by slice and converts its foreground, which may be empty.
// Errors: as NextSlice(), ForegroundOf() and MaskConverter.
absl::StatusOr<ImageObject> ConvertImage(ImageSource& source, const ImageArguments& arguments,
                                         KeptVoxels kept, const exec::Context& context);

struct CollectedLabels {
  ImageInfo info;
  LabeledObjects objects;
  uint64_t left_out = 0;  // labels with fewer voxels than wanted
};

// Gathers the wanted labels of an image that have `min_voxels` or more; there may be none.
// Errors: as NextSlice(), LabelSlice() and LabelCollector.
absl::StatusOr<CollectedLabels> CollectLabels(ImageSource& source, const ImageArguments& arguments,
                                              uint64_t min_voxels, const exec::Context& context);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_CONVERT_IMAGE_H_
