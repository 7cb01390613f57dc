#ifndef BCCSKEL_CORE_MASK_TUBE_BRICKS_H_
#define BCCSKEL_CORE_MASK_TUBE_BRICKS_H_

#include <vector>

#include "core/mask/mask_grid.h"
#include "core/mask/row_tubes.h"
#include "core/volume/volume.h"

namespace bccskel {

// Does: turns the tubes of a mask into the bricks of the exact conversion. Each voxel becomes
//       2 x 2 x 2 refined voxels, the odd points; a corner of refined voxels, an even point, is in
//       the object iff any (k26) or all (k6) of its eight refined voxels are.
// How:  an even brick is a function of 9 x 3 x 5 voxels, an odd one of 8 x 2 x 4. In y and z a
//       corner between two voxels is the "or" or "and" of their words, one inside a voxel its word.
//       In x the eight bits of a byte are doubled to the sixteen of a brick's row, four rows at a
//       time, and joined with themselves moved by one cell.
// Cost: about 300 word operations for a pair of bricks, that is 1024 points.
class TubeBricks {
 public:
  explicit TubeBricks(MaskAdjacency adjacency) : adjacency_(adjacency) {}

  // Needs: tubes in the order in which RowTubes gives them.
  void Add(const RowTube& tube);
  size_t brick_count() const { return keys_.size(); }
  Volume Finish(LatticeExtent extent, const Placement& placement) &&;

 private:
  template <MaskAdjacency kAdjacency>
  void AddTube(const RowTube& tube);
  void Push(BrickCoordinates brick, const BrickBits& bits);

  const MaskAdjacency adjacency_;
  std::vector<BrickKey> keys_;
  std::vector<BrickBits> bricks_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_MASK_TUBE_BRICKS_H_
