#ifndef BCCSKEL_CORE_IMPORT_IMAGE_ZARR_METADATA_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_ZARR_METADATA_H_

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/image/chunk_codec.h"
#include "core/import/image/image_info.h"
#include "core/import/image/image_options.h"
#include "core/import/image/slice_buffer.h"

namespace bccskel {

// What .zarray says of an array, axes in the array's order. README.md names the specification.
struct ZarrArray {
  std::vector<int64_t> shape;
  std::vector<int64_t> chunks;  // as many, positive; their product is below the limit
  VoxelType type = VoxelType::kUint8;
  StoredHalves halves = StoredHalves::kNo;
  std::endian byte_order = std::endian::little;
  bool last_axis_fastest = true;  // in a chunk: order C
  char separator = '.';           // in the names of chunks
  ChunkCodec codec = ChunkCodec::kNone;
  std::array<std::byte, 8> fill = {};  // the bytes of one voxel, in byte_order

  uint64_t ChunkBytes() const;
};

// Errors: INVALID_ARGUMENT (malformed, names the field), UNIMPLEMENTED (filters, codecs and types
//         that are not supported), RESOURCE_EXHAUSTED (chunks over the limit).
absl::StatusOr<ZarrArray> ParseZarrArray(const nlohmann::json& metadata, const ImageLimits& limits);

// One level of a pyramid.
struct ZarrLevel {
  std::string path;                 // of its array, from the group's folder
  std::vector<char> axes;           // 't', 'c', 'z', 'y', 'x'; empty: not named
  std::vector<double> scale;        // as many as axes; empty: 1
  std::vector<double> translation;  // as many as axes, of the first voxel's center; empty: 0
  std::string unit;
};

// The chosen level of the first image that an OME group's .zattrs describe (versions 0.1 to 0.4).
// Errors: INVALID_ARGUMENT (malformed, a level that is not there), UNIMPLEMENTED (other versions,
//         axes and transformations).
absl::StatusOr<ZarrLevel> ParseMultiscales(const nlohmann::json& attributes,
                                           const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_ZARR_METADATA_H_
