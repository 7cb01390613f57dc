#ifndef BCCSKEL_CLIENT_CLI_LOAD_IMAGE_H_
#define BCCSKEL_CLIENT_CLI_LOAD_IMAGE_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/convert_image.h"
#include "client/export/world.h"

namespace bccskel::cli {

// The object of a file.
// Errors: as OpenImage() and ConvertImage(), and labels of no voxel; every message names the path.
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
