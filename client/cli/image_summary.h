#ifndef BCCSKEL_CLIENT_CLI_IMAGE_SUMMARY_H_
#define BCCSKEL_CLIENT_CLI_IMAGE_SUMMARY_H_

#include <optional>
#include <string>

#include "client/cli/image_values.h"
#include "client/cli/load_image.h"

namespace bccskel::cli {

// "NIfTI-1, 101 x 101 x 41 uint8, 50,899 voxels".
std::string ImagePhrase(const ImageStage& image);

// Everything that is known about an image and its foreground, a line each; and the same as a JSON
// object, with the values where they are known.
std::string ImageText(const ImageStage& image);
std::string ImageJson(const ImageStage& image, const std::optional<ImageValues>& values = {});

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_IMAGE_SUMMARY_H_
