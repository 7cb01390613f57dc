#ifndef BCCSKEL_CORE_THINNING_THINNING_STATE_H_
#define BCCSKEL_CORE_THINNING_THINNING_STATE_H_

#include <span>
#include <vector>

#include "core/exec/uninitialized.h"
#include "core/shells/shells.h"
#include "core/thinning/mark_removable.h"
#include "core/volume/brick_neighbors.h"
#include "core/volume/volume.h"

namespace bccskel {

// The object while it is being thinned, in the brick order of the volume it came from, which must
// outlive it.
struct ThinningState {
  std::span<const BrickKey> keys;
  std::vector<BrickBits> object;                    // padded with one empty brick
  exec::UninitializedVector<BrickBits> candidates;  // points that may be removed
  std::vector<BrickBits> kept;                      // empty, or points that are never removed
  std::span<const BrickNeighborhood> neighbors;

  ThinningState(const Volume& volume, std::span<const LatticePoint> keep);

  size_t brick_count() const { return keys.size(); }
  Sublattice SublatticeOf(BrickIndex brick) const { return keys[brick].sublattice(); }
  ObjectView View() const {
    constexpr size_t kNearBricks = 8192;  // 200 bytes each; only bricks at the surface are in use
    return {object.data(), candidates.data(), neighbors.data(), brick_count() > kNearBricks};
  }

  // The neighbors of a point that are object points.
  NeighborMask NeighborsOf(BrickIndex brick, int bit) const;

  unsigned DiagonalNeighborsOf(BrickIndex brick, int bit) const;

  // The remaining points, with the extent and placement of the original volume.
  Volume ToVolume(const Volume& source) &&;
};

// Where the neighbor of a point in direction `d` is stored.
struct NeighborAddress {
  BrickIndex brick = 0;  // the padding brick if it is not stored
  int bit = 0;
};
NeighborAddress NeighborAt(const ThinningState& state, BrickIndex brick, int bit, Direction d);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_THINNING_STATE_H_
