#ifndef BCCSKEL_CORE_THINNING_MARK_REMOVABLE_H_
#define BCCSKEL_CORE_THINNING_MARK_REMOVABLE_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/lattice/directions.h"
#include "core/volume/brick.h"
#include "core/volume/brick_neighbors.h"

// Does:  finds the points that a direction pass may remove, a brick (512 points) at a time.
// Paper: Conditions 1 to 4 of section 3; end points for Condition 6 of section 4.
// Why it is right: for a border point p of direction d (p - d background, p + d object),
//   Condition 3 holds on all three checking rings through d if and only if, for each of the six
//   neighbors f with d.f < 0 other than -d, p + f in O implies p + f + d in O: each ring through d
//   is a 6-cycle -d, f, f + d, d, ..., so its object part is one arc around d exactly if nothing on
//   the far side stands without its near-side partner. Condition 1 then follows: every object
//   neighbor is joined to d, every background neighbor to -d. And Condition 2 asks for one more
//   object neighbor than d, which the implications turn into "one of the six right-hand sides". So
//   twelve three-input logic operations decide a whole register of points, with no table. All marks
//   of a pass are taken on one frozen object, which is what the proof needs.
// Cost:  15 bricks of 64 bytes are read for each brick. A pre-test for border points alone would be
//        twice as fast but every second brick passes it.
// Differs from the paper: no per-point test and no point lists; same points removed.

namespace bccskel {

// What the kernels read. The arrays do not change during a pass.
struct ObjectView {
  const BrickBits* object = nullptr;      // padded with an empty brick at keys.size()
  const BrickBits* candidates = nullptr;  // may be removed: reached by the shells, not kept
  const BrickNeighborhood* neighbors = nullptr;
  bool is_far = false;  // the object exceeds the near caches
};

// Prefetches later bricks of a list while the current one is processed, if the object exceeds the
// near caches: otherwise the processor waits for fewer cache lines at once than it could. Of the
// bricks around a brick, those below and beside it have just been read for others. `also` is read
// like the object. Ball of 64 million points: 22 ns per visit of the directional method instead of
// 30; of 8 million 12.6 instead of 14.6; of 100,000, where everything is near, half a nanosecond
// more.
inline void PrefetchAhead(const ObjectView& view, Sublattice sublattice,
                          std::span<const BrickIndex> bricks, size_t at,
                          const BrickBits* also = nullptr) {
  constexpr size_t kNeighborsAhead = 12, kBricksAhead = 6;
  const size_t above = 12, diagonal = sublattice == Sublattice::kOdd ? 4 : 0;
  const size_t last = bricks.size() - 1;
  __builtin_prefetch(&view.neighbors[bricks[std::min(at + kNeighborsAhead, last)]]);
  const BrickIndex brick = bricks[std::min(at + kBricksAhead, last)];
  const BrickNeighborhood& near = view.neighbors[brick];
  __builtin_prefetch(&view.candidates[brick]);
  for (const size_t position : {above, diagonal}) {
    __builtin_prefetch(&view.object[near[position]]);
    if (also != nullptr) __builtin_prefetch(&also[near[position]]);
  }
}

struct MarkedBrick {
  BrickBits marks;  // never empty
  BrickIndex brick = 0;
};

// Conditions 1 to 4 along d for all candidates of the given bricks. As MarkEndPoints() it adds the
// bricks with end points to `ends`, since both read the same neighbors.
// Shapes: `bricks` all of `sublattice`; `marked` has room for bricks.size().
// Returns: how many bricks have marks; they come in the order of `bricks`.
size_t MarkRemovable(const ObjectView& view, Sublattice sublattice, DiagonalDirection d,
                     std::span<const BrickIndex> bricks, MarkedBrick* marked,
                     std::vector<MarkedBrick>& ends);

// Adds the end points among the candidates of the given bricks. Shapes: `bricks` all of
// `sublattice`.
void MarkEndPoints(const ObjectView& view, Sublattice sublattice,
                   std::span<const BrickIndex> bricks, std::vector<MarkedBrick>& ends);

// Points with two adjacent object neighbors among the candidates: every simple point that is not an
// end point is one of them. Shapes and result as MarkRemovable().
size_t MarkPossiblySimple(const ObjectView& view, Sublattice sublattice,
                          std::span<const BrickIndex> bricks, MarkedBrick* marked);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_MARK_REMOVABLE_H_
