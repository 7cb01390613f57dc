#ifndef BCCSKEL_CORE_THINNING_OPEN_SHELL_H_
#define BCCSKEL_CORE_THINNING_OPEN_SHELL_H_

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/shells/slice_bricks.h"
#include "core/thinning/work_list.h"
#include "core/volume/brick.h"

// Condition 5: the points of a shell become candidates.

namespace bccskel {

// The number of shells extracted from the planes at a time: planes are not in cache, six per brick,
// and would otherwise be read for every shell. Aligned groups of shells share all but two planes.
inline constexpr int32_t kShellsAtOnce = 4;

// Extracts the points of kShellsAtOnce shells from `first` on, modulo 64.
// Shapes: `points` has room for kShellsAtOnce times the bricks; the points of shell first + k begin
//         at k times the number of bricks.
// Needs:  first is a multiple of kShellsAtOnce.
void CutShells(std::span<const ShellPlanes> planes, int32_t first,
               std::span<const BrickIndex> bricks, BrickBits* points);

// What opening a shell reads and changes.
struct OpeningView {
  const BrickBits* object = nullptr;
  const BrickBits* kept = nullptr;  // points that are never removed; null if there are none
  BrickBits* candidates = nullptr;
  DirtyBricks dirty;
  DirtyMask* enabled = nullptr;
  DirtyMask watched = 0;  // the bits of a brick with candidates
  DirtyMask woken = 0;    // the bits of a brick with new candidates
};

// Condition 5: makes the points of one shell in the given bricks candidates.
// Shapes: `points` are those of the shell, as many as bricks. Returns: how many points.
uint64_t OpenShell(const OpeningView& view, std::span<const BrickIndex> bricks,
                   const BrickBits* points);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_OPEN_SHELL_H_
