#ifndef BCCSKEL_CORE_IMPORT_IMAGE_ZARR_METADATA_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_ZARR_METADATA_H_

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "core/import/image/chunk_codec.h"
#include "core/import/image/image_info.h"
#include "core/import/image/image_options.h"
#include "core/import/image/slice_buffer.h"

namespace bccskel {

// Zarr 3 may store several chunks in one file, a shard, next to an index of their places.
struct ZarrShards {
  std::vector<int64_t> chunks;  // along each axis, of one shard; positive
  bool index_first = false;     // else it ends the file
  bool has_checksum = true;     // a CRC-32C behind the index
};

// What .zarray (Zarr 2) or zarr.json (Zarr 3) states about an array, axes in the array's order.
struct ZarrArray {
  std::vector<int64_t> shape;
  std::vector<int64_t> chunks;  // as many, positive; their product is below the limit
  VoxelType type = VoxelType::kUint8;
  StoredHalves halves = StoredHalves::kNo;
  std::endian byte_order = std::endian::little;
  std::vector<size_t> order;  // of the axes in a chunk, the one that varies fastest last
  std::string key_prefix;     // the name of a chunk is this and its index
  char separator = '.';       // in the names of chunks
  ChunkCodec codec = ChunkCodec::kNone;
  bool has_checksum = false;  // a CRC-32C behind each chunk
  std::optional<ZarrShards> shards;
  std::array<std::byte, 8> fill = {};  // the bytes of one voxel, in byte_order
  std::vector<char> axes;              // the names, if all are 't', 'c', 'z', 'y' or 'x'

  uint64_t ChunkBytes() const;
};

// `metadata`: of either version.
// Errors: INVALID_ARGUMENT (malformed, names the field), UNIMPLEMENTED (filters, codecs, types and
//         extensions that are not supported), RESOURCE_EXHAUSTED (chunks over the limit).
absl::StatusOr<ZarrArray> ParseZarrArray(const nlohmann::json& metadata, const ImageLimits& limits);
// The same for Zarr 3 alone.
absl::StatusOr<ZarrArray> ParseZarr3Array(const nlohmann::json& metadata,
                                          const ImageLimits& limits);

// Shared by both versions. Errors: as ParseZarrArray().
absl::Status CheckZarrChunks(const ZarrArray& array, const ImageLimits& limits);
absl::Status ReadZarrFill(const nlohmann::json& value, ZarrArray& array);
absl::StatusOr<ChunkCodec> ZarrCodecOf(std::string_view name);

// One level of a pyramid.
struct ZarrLevel {
  std::string path;                 // of its array, from the group's folder
  std::vector<char> axes;           // 't', 'c', 'z', 'y', 'x'; empty: not named
  std::vector<double> scale;        // as many as axes; empty: 1
  std::vector<double> translation;  // as many as axes, of the first voxel's center; empty: 0
  std::string unit;
};

// The chosen level of the first image that the attributes of an OME group describe (versions 0.1 to
// 0.5).
// Errors: INVALID_ARGUMENT (malformed, a level that is not there), UNIMPLEMENTED (other versions,
//         axes and transformations).
absl::StatusOr<ZarrLevel> ParseMultiscales(const nlohmann::json& attributes,
                                           const ImageOptions& options);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_ZARR_METADATA_H_
