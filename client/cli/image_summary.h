#ifndef BCCSKEL_CLIENT_CLI_IMAGE_SUMMARY_H_
#define BCCSKEL_CLIENT_CLI_IMAGE_SUMMARY_H_

#include <string>

#include "client/cli/load_image.h"

namespace bccskel::cli {

// "NIfTI-1, 101 x 101 x 41 uint8, 50,899 voxels".
std::string ImagePhrase(const ImageStage& image);

// Everything that is known about an image and its foreground, a line each; and the same as a JSON
// object.
std::string ImageText(const ImageStage& image);
std::string ImageJson(const ImageStage& image);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_IMAGE_SUMMARY_H_
