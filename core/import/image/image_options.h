#ifndef BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_OPTIONS_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_OPTIONS_H_

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>

#include "core/import/image/image_info.h"
#include "core/import/image/image_limits.h"

namespace bccskel {

// What a raw file cannot say itself.
struct RawLayout {
  std::array<int64_t, 3> size = {0, 0, 0};  // x, y, z; x varies fastest
  VoxelType type = VoxelType::kUint8;
  std::endian byte_order = std::endian::little;
  uint64_t header_bytes = 0;  // in front of the voxels; of the expanded bytes, if gzip is used
};

struct ImageOptions {
  // Reads the file as raw voxels and ignores its header.
  std::optional<RawLayout> raw;
  // Overrides the spacing of the file, or supplies a missing one.
  std::optional<std::array<double, 3>> spacing;
  // The same for the unit of lengths.
  std::optional<std::string> unit;
  // Of a TIFF file or OME-Zarr folder with several, counted from 0; of a segmentation of DICOM a
  // segment, by its number.
  std::optional<int64_t> channel;
  std::optional<int64_t> time;
  // Of a pyramid (OME-Zarr, precomputed): 0, the default, is the finest.
  std::optional<int64_t> level;
  // Of a folder of DICOM with several: the number or the unique identifier.
  std::optional<std::string> series;
  // Of an .npz archive with several: the name.
  std::optional<std::string> array;
  ImageLimits limits;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_OPTIONS_H_
