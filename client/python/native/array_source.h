#ifndef BCCSKEL_CLIENT_PYTHON_NATIVE_ARRAY_SOURCE_H_
#define BCCSKEL_CLIENT_PYTHON_NATIVE_ARRAY_SOURCE_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "absl/status/statusor.h"
#include "core/import/image/image_source.h"
#include "core/import/image/slice_buffer.h"

namespace bccskel::python {

// An array in memory that another object owns.
struct ArrayView {
  const std::byte* data = nullptr;
  VoxelType type = VoxelType::kUint8;
  std::array<int64_t, 3> shape = {};    // z, y, x
  std::array<int64_t, 3> strides = {};  // bytes; any sign
};

// An array as an image. Does not copy contiguous slices; copies others one at a time.
class ArraySource final : public ImageSource {
 public:
  // Errors: as SizeOfAxes().
  static absl::StatusOr<ArraySource> Create(const ArrayView& array, const Placement& placement);

 private:
  ArraySource(const ArrayView& array, ImageInfo info)
      : ImageSource(std::move(info)), array_(array) {}
  absl::StatusOr<SliceValues> ReadSlice(int32_t z) override;
  template <typename T>
  SliceValues Values(const std::byte* slice);

  ArrayView array_;
  SliceBuffer buffer_;
};

}  // namespace bccskel::python

#endif  // BCCSKEL_CLIENT_PYTHON_NATIVE_ARRAY_SOURCE_H_
