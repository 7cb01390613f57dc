#ifndef BCCSKEL_SERVER_ADMISSION_MEMORY_ESTIMATE_H_
#define BCCSKEL_SERVER_ADMISSION_MEMORY_ESTIMATE_H_

#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/io/volume_header.h"
#include "core/labels/voxel_runs.h"
#include "core/mask/mask_grid.h"
#include "core/prepare/prepare.h"
#include "core/volume/volume.h"

namespace bccskel::server {

// These saturate, so that hostile declarations cannot make a sum wrap around.
inline uint64_t SaturatingAdd(uint64_t a, uint64_t b) {
  uint64_t sum = 0;
  return __builtin_add_overflow(a, b, &sum) ? std::numeric_limits<uint64_t>::max() : sum;
}

inline uint64_t SaturatingMultiply(uint64_t a, uint64_t b) {
  uint64_t product = 0;
  return __builtin_mul_overflow(a, b, &product) ? std::numeric_limits<uint64_t>::max() : product;
}

// Volumes of at most this many occupied bricks (1 M points) get one thread: more would not make
// them faster, and eight of them are served better side by side.
inline constexpr uint64_t kSmallJobBricks = 2048;

// Memory of the pipeline per occupied brick. Peak resident memory of the server grew by 2.1 KiB a
// brick for a ball of 17 M points (70 k bricks, 16-bit distances); 32-bit distances, which objects
// wider than about 600 lattice units have, add 1 KiB; Euclidean ones take 3.3 KiB with the shells
// that are made of them, and 2 KiB more in objects of up to 4096 bricks with different spacings.
inline constexpr uint64_t kPipelineBytesPerBrick = 5120;
// Per job: stacks, tables, chunks in flight and the allocator's slack.
inline constexpr uint64_t kFixedJobBytes = uint64_t{4} << 20;

// Whether to keep the points of each thinned shell for the caller.
enum class ShellPointsWanted : uint8_t { kNone, kAll };

// Bytes per brick for the points of all shells as they are sent: 3 for each of 512 points, whose
// neighbors in a brick are near, and 12 more for the first point of a brick in each of 64 shells.
inline constexpr uint64_t kShellPointsBytesPerBrick = 3 * 512 + 12 * 64;
constexpr uint64_t ShellPointsBytes(ShellPointsWanted wanted, uint64_t bricks) {
  if (wanted == ShellPointsWanted::kNone) return 0;
  return SaturatingMultiply(bricks, kShellPointsBytesPerBrick);
}

// Peak memory for receiving, decoding and thinning a volume of this declaration if every brick that
// it may have is occupied.
uint64_t BytesToSkeletonize(const VolumeHeader& declared, uint64_t size_bytes,
                            ShellPointsWanted shell_points = ShellPointsWanted::kNone);

// Peak memory for thinning this volume.
uint64_t BytesToSkeletonize(const Volume& volume,
                            ShellPointsWanted shell_points = ShellPointsWanted::kNone);

// `wanted`, but at most `threads`; all of them if `wanted` is 0.
int ThreadsWithin(int threads, int wanted);

// The number of threads, at most `threads`, for a job of this size. `wanted` 0 leaves the choice to
// the server.
int ThreadsFor(uint64_t bricks, int wanted, int threads);

// What is known about a volume of labels before its first byte.
struct LabelVolumeHeader {
  MaskGrid grid;
  MaskAdjacency adjacency = MaskAdjacency::k26;
  VoxelPoints points = VoxelPoints::kTwo;
  int label_bytes = 1;  // of one voxel: 1, 2, 4 or 8
  VolumeCompression compression = VolumeCompression::kNone;

  // Promises about the requested labels, enforced while decoding.
  uint64_t max_voxels = 0;        // of all labels together
  uint64_t max_label_voxels = 0;  // of any one label
  uint64_t max_runs = 0;          // longest stretches of one label along x
  uint64_t max_labels = 0;

  uint64_t DecodedBytes() const;  // saturates
};

// Replaces each missing promise (0) with the worst case that grid and type allow. `labels_wanted` 0
// means all.
LabelVolumeHeader WithWorstCase(LabelVolumeHeader header, uint64_t labels_wanted);

// Memory for computing `threads` labels of the largest declared size at the same time, if they are
// no thinner than most. For thinner ones the job asks for more once it knows them.
uint64_t BytesToComputeLabels(const LabelVolumeHeader& declared, int threads);
// Peak memory for receiving the volume and for computing while its runs are in memory.
uint64_t BytesToSkeletonizeLabels(const LabelVolumeHeader& declared, int threads);

// An upper bound of the number of bricks in any exact conversion of the object with these parts of
// voxels; most conversions reach it. With cavity filling it counts all bricks between others of a
// row. Cost: a few operations per run.
uint64_t MostBricksOf(const LabeledObject& object, const VoxelParts& parts,
                      CavityFilling cavities = CavityFilling::kOff);
// Peak memory for converting and thinning an object of this many bricks, including its graph.
uint64_t BytesToComputeLabel(uint64_t bricks);
// Memory that the object's runs occupy.
uint64_t BytesOf(const LabeledObject& object);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_ADMISSION_MEMORY_ESTIMATE_H_
