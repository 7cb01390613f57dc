#ifndef BCCSKEL_CORE_LABELS_VOXEL_RUNS_H_
#define BCCSKEL_CORE_LABELS_VOXEL_RUNS_H_

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

#include "core/mask/mask_grid.h"

namespace bccskel {

// Voxels [begin, end) of row y of slice z.
struct VoxelRun {
  int32_t z = 0;
  int32_t y = 0;
  int32_t begin = 0;
  int32_t end = 0;

  friend constexpr auto operator<=>(const VoxelRun&, const VoxelRun&) = default;
};

// Voxels low <= v < high.
struct VoxelBox {
  std::array<int32_t, 3> low = {};
  std::array<int32_t, 3> high = {};

  friend constexpr bool operator==(const VoxelBox&, const VoxelBox&) = default;
};

// All voxels of one label.
struct LabeledObject {
  uint64_t label = 0;
  uint64_t voxels = 0;
  VoxelBox box = {};
  std::vector<VoxelRun> runs = {};  // in order; runs of a row do not touch
};

struct LabeledObjects {
  MaskGrid grid;
  std::vector<LabeledObject> objects;  // by label
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LABELS_VOXEL_RUNS_H_
