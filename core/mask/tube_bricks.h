#ifndef BCCSKEL_CORE_MASK_TUBE_BRICKS_H_
#define BCCSKEL_CORE_MASK_TUBE_BRICKS_H_

#include <vector>

#include "core/mask/mask_grid.h"
#include "core/mask/row_tubes.h"
#include "core/volume/layer_part.h"
#include "core/volume/volume.h"

namespace bccskel {

// Does:  turns the tubes of a mask into the bricks of the exact conversion. Odd points are the
//        voxels, even points their corners. For (26, 6) a corner that touches the object belongs to
//        it, unless along some axis three consecutive slabs of 2 x 2 voxels (the one below it, the
//        one above it and the next one) are occupied, empty and occupied: such a corner and the one
//        after it would be neighbors across a gap. For (6, 26) this rule gives the background, and
//        the object is the rest. README.md has the proof.
// Cost:  64 voxels of x at a time, with about 20 word operations for a row of corners; four rows of
//        16 bits make a word of a brick.
class TubeBricks {
 public:
  explicit TubeBricks(MaskAdjacency adjacency, const LayerPart& part = {})
      : adjacency_(adjacency), part_(part) {}

  // Needs: tubes in the order of RowTubes.
  void Add(const RowTube& tube);
  size_t brick_count() const { return keys_.size(); }
  Volume Finish(LatticeExtent extent, const Placement& placement) &&;

 private:
  template <MaskAdjacency kAdjacency>
  void AddTube(const RowTube& tube);
  void Push(BrickCoordinates brick, const BrickBits& bits);

  const MaskAdjacency adjacency_;
  const LayerPart part_;
  std::vector<BrickKey> keys_;
  std::vector<BrickBits> bricks_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_MASK_TUBE_BRICKS_H_
