#ifndef BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_SOURCE_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_SOURCE_H_

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <variant>

#include "absl/status/statusor.h"
#include "core/import/image/image_info.h"

namespace bccskel {

using SliceValues =
    std::variant<std::span<const uint8_t>, std::span<const int8_t>, std::span<const uint16_t>,
                 std::span<const int16_t>, std::span<const uint32_t>, std::span<const int32_t>,
                 std::span<const uint64_t>, std::span<const int64_t>, std::span<const float>,
                 std::span<const double>>;

// Shapes: `values` holds nx * ny of them, x fastest.
struct ImageSlice {
  int32_t nx = 0;
  int32_t ny = 0;
  int32_t z = 0;
  SliceValues values;
};

// An open image, read once from the first slice to the last. Memory is proportional to a slice, for
// images in chunks to a slab of slices, never to the file; README.md names the one exception.
class ImageSource {
 public:
  virtual ~ImageSource() = default;

  const ImageInfo& info() const { return info_; }

  // Replaces the spacing of the file. Errors: as PlacementOfSpacing().
  absl::Status SetSpacing(const std::array<double, 3>& spacing);

  void SetUnit(const std::string& unit) { info_.unit = unit; }

  // The slice z = 0, then 1, and so on; its values live until the next call.
  // Errors: INVALID_ARGUMENT (cut or damaged data), OUT_OF_RANGE after the last slice,
  //         RESOURCE_EXHAUSTED (memory), and read errors of the system.
  absl::StatusOr<ImageSlice> NextSlice();

 protected:
  explicit ImageSource(ImageInfo info) : info_(std::move(info)) {}

  // The values of slice z, which comes after z - 1. May throw std::bad_alloc.
  virtual absl::StatusOr<SliceValues> ReadSlice(int32_t z) = 0;

  ImageInfo info_;

 private:
  int32_t next_z_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_SOURCE_H_
