#ifndef BCCSKEL_CORE_MASK_MASK_TOPOLOGY_H_
#define BCCSKEL_CORE_MASK_MASK_TOPOLOGY_H_

#include <cstdint>

#include "core/certificate/certificate.h"
#include "core/mask/mask_grid.h"
#include "core/mask/row_tubes.h"
#include "core/mask/run_components.h"
#include "core/mask/slice_rows.h"

namespace bccskel {

// Counts the Betti numbers of a mask on the cubic grid, slice by slice.
// Memory: the runs of two slices. Cost: proportional to the runs and the occupied words.
class MaskTopology {
 public:
  MaskTopology(const MaskGrid& grid, MaskAdjacency adjacency);

  // Needs: z increases from call to call; omitted slices are empty.
  void AddSlice(int32_t z, const SliceRows& rows);
  // The tubes of the same slices, for the Euler characteristic.
  void AddTube(const RowTube& tube);

  uint64_t voxels() const { return voxels_; }
  BettiNumbers Finish() &&;

 private:
  void EndSlice();

  const MaskAdjacency adjacency_;
  RunComponents object_;
  RunComponents background_;
  int32_t last_z_ = 0;
  int64_t euler_ = 0;
  uint64_t voxels_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_MASK_MASK_TOPOLOGY_H_
