#ifndef BCCSKEL_CORE_LABELS_RUN_LOOKUP_H_
#define BCCSKEL_CORE_LABELS_RUN_LOOKUP_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/labels/voxel_runs.h"

namespace bccskel {

// Position of a run in its object.
using RunIndex = size_t;

// Finds voxels of an object by their place.
class RunLookup {
 public:
  explicit RunLookup(std::span<const VoxelRun> runs) : runs_(runs) {}

  // The run that holds the voxel.
  std::optional<RunIndex> Find(const std::array<int32_t, 3>& voxel) const;
  // Half-open range of the runs of a row.
  struct Range {
    RunIndex begin;
    RunIndex end;
  };
  Range Row(int32_t z, int32_t y) const;

 private:
  std::span<const VoxelRun> runs_;
};

// The first run, in order, of the component that each run belongs to.
std::vector<RunIndex> ComponentsOfRuns(std::span<const VoxelRun> runs, MaskAdjacency adjacency);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LABELS_RUN_LOOKUP_H_
