#ifndef BCCSKEL_CORE_IMPORT_IMAGE_PNG_IMAGE_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_PNG_IMAGE_H_

#include <memory>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/import/image/image_file.h"
#include "core/import/image/image_options.h"
#include "core/import/image/image_source.h"

namespace bccskel {

bool IsPng(std::string_view front);

// Opens a PNG file, an image of one slice. Values are as stored: gray levels of 1 to 16 bits, the
// indices of a palette, and the one value of red, green and blue where these are equal in every
// pixel. The spacing is 1 or that of the options, since the density that a file states is mostly
// that of a screen.
// Errors: INVALID_ARGUMENT (damaged, cut, too short for its size; when its slice is read also a
//         pixel that is colored or transparent, with its place), RESOURCE_EXHAUSTED.
absl::StatusOr<std::unique_ptr<ImageSource>> OpenPng(std::shared_ptr<const ImageFile> file,
                                                     const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_PNG_IMAGE_H_
