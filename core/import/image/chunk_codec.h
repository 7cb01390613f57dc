#ifndef BCCSKEL_CORE_IMPORT_IMAGE_CHUNK_CODEC_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_CHUNK_CODEC_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/import/image/image_file.h"

namespace bccskel {

// How the bytes of a chunk are compressed.
enum class ChunkCodec {
  kNone,
  kDeflate,  // gzip or zlib
  kZstd,
  kLz4,    // one block behind its expanded length, as numcodecs writes it
  kBlosc,  // with any of its own codecs
};

// Expands a file that holds one chunk of into.size() bytes; a file far longer than these is refused
// before it is read.
// Errors: INVALID_ARGUMENT for damaged bytes and for those that expand to fewer or more.
absl::Status ExpandChunk(ChunkCodec codec, const std::shared_ptr<const ImageFile>& file,
                         std::span<std::byte> into);

// `length` bytes of a file, without the CRC-32C behind them if there is one.
// Errors: INVALID_ARGUMENT if the file ends before or the bytes do not match their checksum.
absl::StatusOr<std::string> ReadStored(const ImageFile& file, uint64_t offset, uint64_t length,
                                       bool has_checksum);

// Expands one chunk of Neuroglancer's compressed segmentation with one channel.
// `size` and `block`: voxels along x, y and z, positive. `into`: x fastest, little endian, `bytes`
// (4 or 8) for each voxel.
// Errors: INVALID_ARGUMENT where the bytes point outside themselves or are of no such kind.
absl::Status ExpandCompressedSegmentation(std::span<const std::byte> packed,
                                          const std::array<int64_t, 3>& size,
                                          const std::array<int64_t, 3>& block, size_t bytes,
                                          std::span<std::byte> into);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_CHUNK_CODEC_H_
