#include "core/import/image/image_source.h"

#include <new>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {

absl::StatusOr<ImageSlice> ImageSource::NextSlice() {
  const ImageSize& size = info_.size;
  if (next_z_ >= size.nz) {
    return absl::OutOfRangeError(absl::StrFormat("the image has %d slices", size.nz));
  }
  try {
    BCCSKEL_ASSIGN_OR_RETURN(const SliceValues values, ReadSlice(next_z_));
    return ImageSlice{.nx = size.nx, .ny = size.ny, .z = next_z_++, .values = values};
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("not enough memory for slices of %d x %d", size.nx, size.ny));
  }
}

absl::Status ImageSource::SetSpacing(const std::array<double, 3>& spacing) {
  BCCSKEL_ASSIGN_OR_RETURN(info_.placement, WithSpacing(info_.placement, spacing));
  return absl::OkStatus();
}

}  // namespace bccskel
