#include "client/python/native/array_source.h"

#include <cstring>
#include <span>

#include "core/exec/status_macros.h"

namespace bccskel::python {

absl::StatusOr<ArraySource> ArraySource::Create(const ArrayView& array,
                                                const Placement& placement) {
  const auto [nz, ny, nx] = array.shape;
  BCCSKEL_ASSIGN_OR_RETURN(const ImageSize size,
                           SizeOfAxes(std::array<int64_t, 3>{nx, ny, nz}, ImageLimits()));
  return ArraySource(array, ImageInfo{.format = "array",
                                      .size = size,
                                      .type = array.type,
                                      .placement = placement,
                                      .unit = "",
                                      .world = ""});
}

template <typename T>
SliceValues ArraySource::Values(const std::byte* slice) {
  const auto [nz, ny, nx] = array_.shape;
  const auto [step_z, step_y, step_x] = array_.strides;
  constexpr auto kSize = static_cast<int64_t>(sizeof(T));
  const bool whole = step_x == kSize && step_y == nx * kSize;
  if (whole && reinterpret_cast<uintptr_t>(slice) % alignof(T) == 0) {
    return std::span(reinterpret_cast<const T*>(slice), info_.size.SliceVoxels());
  }
  buffer_.Resize(array_.type, info_.size.SliceVoxels());
  std::byte* to = buffer_.bytes().data();
  for (int64_t y = 0; y < ny; ++y) {
    const std::byte* from = slice + y * step_y;
    for (int64_t x = 0; x < nx; ++x, to += kSize, from += step_x) std::memcpy(to, from, sizeof(T));
  }
  return buffer_.values();
}

absl::StatusOr<SliceValues> ArraySource::ReadSlice(int32_t z) {
  const std::byte* slice = array_.data + z * array_.strides[0];
  return WithVoxelType(array_.type, [&](auto zero) { return Values<decltype(zero)>(slice); });
}

}  // namespace bccskel::python
