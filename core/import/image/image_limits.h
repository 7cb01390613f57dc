#ifndef BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_LIMITS_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_LIMITS_H_

#include <cstdint>

#include "core/lattice/lattice_point.h"

namespace bccskel {

// What an image may declare. It is compared with the bytes that are there before memory is taken.
struct ImageLimits {
  // An image of n voxels fills 2 n + 1 cells of the bcc grid.
  int64_t max_axis_voxels = (kMaxExtentCells - 1) / 2;
  uint64_t max_slice_voxels = uint64_t{1} << 30;
  uint64_t max_voxels = uint64_t{1} << 36;  // bounds how long a small compressed file can take
  uint64_t max_header_bytes = uint64_t{1} << 20;
  // Slices scattered over a file are gathered this many bytes at a time, or one by one.
  uint64_t max_slab_bytes = uint64_t{64} << 20;
  // Of images in chunks: of one expanded chunk, of the slices that are gathered at a time, and how
  // many chunks there may be.
  uint64_t max_chunk_bytes = uint64_t{1} << 30;
  uint64_t max_chunk_slab_bytes = uint64_t{1} << 30;
  uint64_t max_chunks = uint64_t{1} << 24;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_LIMITS_H_
