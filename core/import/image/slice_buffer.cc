#include "core/import/image/slice_buffer.h"

#include <algorithm>
#include <cstring>

namespace bccskel {
namespace {

template <typename T>
std::span<const T> SpanOf(const exec::UninitializedVector<std::byte>& bytes) {
  // Allocated by operator new, so aligned for every T; arrays of bytes may hold any such object.
  return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

template <size_t kBytes>
void ReverseEach(std::span<std::byte> bytes) {
  for (size_t at = 0; at + kBytes <= bytes.size(); at += kBytes) {
    std::reverse(bytes.data() + at, bytes.data() + at + kBytes);
  }
}

}  // namespace

void SliceBuffer::Resize(VoxelType type, uint64_t voxels) {
  type_ = type;
  bytes_.resize(static_cast<size_t>(voxels * VoxelBytes(type)));
}

SliceValues SliceBuffer::values() const {
  return WithVoxelType(type_, [this]<typename T>(T) -> SliceValues { return SpanOf<T>(bytes_); });
}

void SliceBuffer::SwapFrom(std::endian order) {
  if (order == std::endian::native) return;
  switch (VoxelBytes(type_)) {
    case 2:
      return ReverseEach<2>(bytes_);
    case 4:
      return ReverseEach<4>(bytes_);
    case 8:
      return ReverseEach<8>(bytes_);
    default:
      return;
  }
}

SliceValues SliceBuffer::Scaled(double slope, double intercept) {
  std::visit(
      [&](const auto values) {
        scaled_.resize(values.size());
        for (size_t n = 0; n < values.size(); ++n) {
          scaled_[n] = slope * static_cast<double>(values[n]) + intercept;
        }
      },
      values());
  return std::span<const double>(scaled_);
}

}  // namespace bccskel
