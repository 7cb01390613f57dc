#ifndef BCCSKEL_SERVER_ADMISSION_LABEL_MEMORY_ESTIMATE_H_
#define BCCSKEL_SERVER_ADMISSION_LABEL_MEMORY_ESTIMATE_H_

#include <cstdint>

#include "core/io/volume_header.h"
#include "core/labels/voxel_runs.h"
#include "core/mask/mask_grid.h"
#include "core/prepare/prepare.h"

namespace bccskel::server {

// What is known about a volume of labels before its first byte.
struct LabelVolumeHeader {
  MaskGrid grid;
  MaskAdjacency adjacency = MaskAdjacency::k26;
  VoxelPoints points = VoxelPoints::kTwo;
  int label_bytes = 1;  // of one voxel: 1, 2, 4 or 8
  VolumeCompression compression = VolumeCompression::kNone;

  // Promises about the labels that are wanted, enforced while decoding.
  uint64_t max_voxels = 0;        // of all together
  uint64_t max_label_voxels = 0;  // of any one
  uint64_t max_runs = 0;          // longest stretches of one label along x
  uint64_t max_labels = 0;

  uint64_t DecodedBytes() const;  // saturates
};

// Replaces a promise that was not made, 0, by the worst that grid and type allow. `labels_wanted` 0
// means all.
LabelVolumeHeader WithWorstCase(LabelVolumeHeader header, uint64_t labels_wanted);

// Memory for computing `threads` labels of the largest size at the same time, when they are no
// thinner than most: where they are, the job asks for more once it knows them.
uint64_t BytesToComputeLabels(const LabelVolumeHeader& declared, int threads);
// Peak memory for receiving the volume, and for computing beside its runs.
uint64_t BytesToSkeletonizeLabels(const LabelVolumeHeader& declared, int threads);

// No exact conversion of the object has more bricks; most have as many. Where cavities are to be
// filled, all bricks between others of a row count.
// Cost: a few operations for each run.
uint64_t MostBricksOf(const LabeledObject& object, VoxelPoints points,
                      CavityFilling cavities = CavityFilling::kOff);
// Peak memory for converting and thinning an object of so many bricks, its graph included.
uint64_t BytesToComputeLabel(uint64_t bricks);
// Memory that the runs of an object keep.
uint64_t BytesOf(const LabeledObject& object);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_ADMISSION_LABEL_MEMORY_ESTIMATE_H_
