#ifndef BCCSKEL_CORE_IMPORT_IMAGE_TIFF_STACK_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_TIFF_STACK_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/import/image/image_options.h"

namespace bccskel {

// Which pages of a TIFF file are the slices of the volume: first_page, first_page + page_step, ...
struct TiffStack {
  int64_t slices = 1;
  int64_t first_page = 0;
  int64_t page_step = 1;
  std::string unit;
  // Of what the description states; nothing where it states none. ImageJ states z alone and leaves
  // x and y to the resolution tags, in lengths of `factors`.
  std::array<std::optional<double>, 3> spacing = {};
  bool has_resolution_tags = false;
  std::array<double, 3> factors = {1, 1, 1};
};

// Reads the first page's description as ImageJ, OME or tifffile ("shaped") write it; any other text
// means one slice a page.
// Errors: INVALID_ARGUMENT for several channels or points of time of which options choose none, a
//         choice that is not there, and a description that contradicts the number of pages;
//         UNIMPLEMENTED for slices behind one page, in other files or in an unknown order.
absl::StatusOr<TiffStack> TiffStackOf(std::string_view description, int64_t pages,
                                      const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_TIFF_STACK_H_
