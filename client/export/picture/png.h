#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_PNG_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_PNG_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/export/picture/surface_image.h"

namespace bccskel::exporting {

// The image as a PNG file.
// Errors: RESOURCE_EXHAUSTED when the compressor gets no memory.
absl::StatusOr<std::string> EncodePng(const RgbaImage& image);

// Base64 with padding (RFC 4648, section 4).
std::string EncodeBase64(std::string_view bytes);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_PNG_H_
