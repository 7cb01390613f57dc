#ifndef BCCSKEL_CORE_IMPORT_IMAGE_STORED_IMAGE_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_STORED_IMAGE_H_

#include <bit>
#include <cstdint>
#include <memory>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/import/image/byte_stream.h"
#include "core/import/image/image_file.h"
#include "core/import/image/image_info.h"
#include "core/import/image/image_source.h"
#include "core/import/image/slice_buffer.h"

namespace bccskel {

// Which axis varies fastest in the file.
enum class VoxelOrder { kXFastest, kZFastest };

// What most formats come down to: one array of voxels in one stream of bytes. The readers of
// headers fill it in; from there on these formats share one way.
struct StoredImage {
  ImageInfo info;
  VoxelType stored_type = VoxelType::kUint8;
  StoredHalves halves = StoredHalves::kNo;
  std::endian byte_order = std::endian::little;
  VoxelOrder voxel_order = VoxelOrder::kXFastest;

  // The voxels' stream begins at `stream_offset` of `file`, or is the zip member of that number; of
  // its expanded bytes, the first `skip` are not voxels.
  std::shared_ptr<const ImageFile> file;
  uint64_t stream_offset = 0;
  Compression compression = Compression::kNone;
  uint64_t skip = 0;

  // Slices give slope * stored + intercept, as float64, unless these are 1 and 0.
  double slope = 1;
  double intercept = 0;

  bool Scaled() const { return slope != 1 || intercept != 0; }
  uint64_t VoxelBytesDeclared() const { return info.size.Voxels() * VoxelBytes(stored_type); }
};

// Compares what the header declares with what the file can hold, then opens the stream.
// Needs:  info.size from SizeOfAxes(), info.placement from PlacementOf...().
// Errors: INVALID_ARGUMENT where the file is too short; RESOURCE_EXHAUSTED (memory).
absl::StatusOr<std::unique_ptr<ImageSource>> OpenStoredImage(StoredImage image,
                                                             const ImageLimits& limits);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_STORED_IMAGE_H_
