#include "core/import/image/slice_buffer.h"

#include <algorithm>
#include <cmath>

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

float FromHalf(uint16_t half) {
  const uint32_t bits = static_cast<uint32_t>(half & 0x7fff) << 13;
  const bool finite = (half & 0x7c00) != 0x7c00;
  // 15 is the middle of its exponents, 127 that of a float.
  const float size =
      finite ? std::bit_cast<float>(bits) * 0x1p112F : std::bit_cast<float>(bits | 0x7f800000);
  return (half & 0x8000) == 0 ? size : -size;
}

}  // namespace

uint16_t NearestHalf(float value) {
  if (std::isnan(value)) return 0x7e00;
  if (std::isinf(value)) return value < 0 ? 0xfc00 : 0x7c00;
  uint16_t nearest = 0;
  // A value is looked for once in an image, so a search does.
  for (uint16_t half = 0; half < 0x7c00; ++half) {
    if (std::abs(FromHalf(half) - std::abs(value)) <
        std::abs(FromHalf(nearest) - std::abs(value))) {
      nearest = half;
    }
  }
  return static_cast<uint16_t>(nearest | (std::signbit(value) ? 0x8000 : 0));
}

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

SliceValues SliceBuffer::Halves() {
  const std::span<const uint16_t> values = SpanOf<uint16_t>(bytes_);
  halves_.resize(values.size());
  std::ranges::transform(values, halves_.begin(), FromHalf);
  return std::span<const float>(halves_);
}

}  // namespace bccskel
