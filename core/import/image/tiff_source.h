#ifndef BCCSKEL_CORE_IMPORT_IMAGE_TIFF_SOURCE_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_TIFF_SOURCE_H_

#include <memory>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/import/image/image_file.h"
#include "core/import/image/image_options.h"
#include "core/import/image/image_source.h"

namespace bccskel {

bool IsTiff(std::string_view front);

// A stack of pages of one size and type; strips and tiles, all compressions of libtiff, BigTIFF.
// Which page is which slice, spacing and unit: TiffStackOf(). Values are those that are stored,
// regardless of the photometric interpretation: bilevel pages give 0 and 1, palettes indices.
// Errors: INVALID_ARGUMENT (damaged or cut, pages that differ, several samples per pixel, other
//         widths of samples), RESOURCE_EXHAUSTED (over a limit), and those of TiffStackOf().
absl::StatusOr<std::unique_ptr<ImageSource>> OpenTiff(std::shared_ptr<const ImageFile> file,
                                                      const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_TIFF_SOURCE_H_
