#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_PNG_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_PNG_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/export/picture/surface_image.h"

namespace bccskel::exporting {

// The image as a PNG file.
// Errors: RESOURCE_EXHAUSTED when the compressor gets no memory.
absl::StatusOr<std::string> EncodePng(const RgbaImage& image);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_PNG_H_
