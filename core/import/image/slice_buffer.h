#ifndef BCCSKEL_CORE_IMPORT_IMAGE_SLICE_BUFFER_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_SLICE_BUFFER_H_

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/exec/uninitialized.h"
#include "core/import/image/image_source.h"

namespace bccskel {

// Calls visit(T{}) with the C++ type of the voxels.
template <typename Visit>
decltype(auto) WithVoxelType(VoxelType type, Visit visit) {
  switch (type) {
    case VoxelType::kUint8:
      return visit(uint8_t{});
    case VoxelType::kInt8:
      return visit(int8_t{});
    case VoxelType::kUint16:
      return visit(uint16_t{});
    case VoxelType::kInt16:
      return visit(int16_t{});
    case VoxelType::kUint32:
      return visit(uint32_t{});
    case VoxelType::kInt32:
      return visit(int32_t{});
    case VoxelType::kUint64:
      return visit(uint64_t{});
    case VoxelType::kInt64:
      return visit(int64_t{});
    case VoxelType::kFloat32:
      return visit(float{});
    case VoxelType::kFloat64:
      break;
  }
  return visit(double{});
}

// Whether the stored values of 16 bits are numbers of half precision, which slices give as float32.
enum class StoredHalves { kNo, kYes };

// The number of half precision (IEEE 754) that is nearest; that of NaN for NaN.
uint16_t NearestHalf(float value);

// The bytes of some voxels of one type. What is written as bytes is read as values.
class SliceBuffer {
 public:
  // Throws std::bad_alloc.
  void Resize(VoxelType type, uint64_t voxels);
  VoxelType type() const { return type_; }
  std::span<std::byte> bytes() { return bytes_; }
  SliceValues values() const;

  // From the file's order to this machine's, in place.
  void SwapFrom(std::endian order);
  // slope * value + intercept of all values, as float64.
  SliceValues Scaled(double slope, double intercept);
  // The values of 16 bits as numbers of half precision (IEEE 754), as float32.
  SliceValues Halves();

 private:
  VoxelType type_ = VoxelType::kUint8;
  exec::UninitializedVector<std::byte> bytes_;
  std::vector<double> scaled_;
  std::vector<float> halves_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_SLICE_BUFFER_H_
