#ifndef BCCSKEL_CORE_IMAGE_TIFF_SOURCE_H_
#define BCCSKEL_CORE_IMAGE_TIFF_SOURCE_H_

#include <memory>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/image/image_file.h"
#include "core/image/image_options.h"
#include "core/image/image_source.h"

namespace bccskel {

bool IsTiff(std::string_view front);

// A stack of pages of one size and type, page z the slice z; strips and tiles, all compressions of
// libtiff, BigTIFF. Bilevel pages give 0 and 1; where white is stored as zero, values are turned
// over, so that white is the larger one; palette pages give their indices. Spacing and unit are
// read where ImageJ wrote the file.
// Errors: INVALID_ARGUMENT (damaged or cut, pages that differ, several samples per pixel, other
//         widths of samples), RESOURCE_EXHAUSTED (over a limit).
absl::StatusOr<std::unique_ptr<ImageSource>> OpenTiff(std::shared_ptr<const ImageFile> file,
                                                      const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMAGE_TIFF_SOURCE_H_
