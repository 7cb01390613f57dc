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

  const ImageInfo& info() const override { return info_; }
  absl::StatusOr<ImageSlice> NextSlice() override;

 private:
  ArraySource(const ArrayView& array, ImageInfo info) : array_(array), info_(std::move(info)) {}
  template <typename T>
  SliceValues Values(const std::byte* slice);

  ArrayView array_;
  ImageInfo info_;
  SliceBuffer buffer_;
  int32_t next_z_ = 0;
};

}  // namespace bccskel::python

#endif  // BCCSKEL_CLIENT_PYTHON_NATIVE_ARRAY_SOURCE_H_
