#ifndef BCCSKEL_CORE_THINNING_MARK_SYMMETRIC_H_
#define BCCSKEL_CORE_THINNING_MARK_SYMMETRIC_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/shells/slice_bricks.h"
#include "core/thinning/mark_removable.h"
#include "core/thinning/thinning.h"
#include "core/thinning/work_list.h"
#include "core/volume/brick.h"

// Does:  finds the points that a symmetric pass may remove, a brick (512 points) at a time.
// Paper: the non-directional conditions that its outlook asks for.
// Why it is right: let S be the candidates that are simple (Condition 1) and not end points
//   (Condition 2). A set of points can be removed in any order, each simple at its turn, if every
//   clique of up to four mutually adjacent points in it has a contractible link: the object points
//   adjacent to all of them. Links are small. The common neighbors of a pair form a cycle of four
//   (D6) or six (D8), and a part of a cycle is contractible iff it is one arc. A triple has two
//   common neighbors, of which exactly one must be an object point. A quadruple has none and is
//   always critical. Rule B unmarks, in every critical clique in S, the point of highest priority:
//   first for pairs, then for triples of the remaining points, then for quadruples of the points
//   that still remain. The result has no critical clique.
// Priorities are strict within a clique: depth in quarters of a lattice unit, and for equal depths
// (x + y + z + pass) modulo 4, which differs between adjacent points. So the lowest point of S is
// never unmarked, and a pass that removes nothing had no simple points.
// Cost:  about 160 logic operations per brick for S and as many for cliques. In smooth objects
//        every fifth brick has a critical pair, which takes 250 more to compare priorities, and
//        every hundredth a critical triple.

namespace bccskel {

// Whether end points are kept (Condition 2).
enum class EndPoints : uint8_t { kStay, kMayGo };

// Writes the set S to `simple[brick]` for each of the bricks. If end points stay, adds those among
// the candidates to `ends`.
// Shapes: `bricks` all of `sublattice`.
// Returns: how many bricks have points in S; they come first in `bricks`, in order.
size_t FindSimple(const ObjectView& view, Sublattice sublattice, EndPoints end_points,
                  std::span<BrickIndex> bricks, BrickBits* simple, std::vector<MarkedBrick>& ends);

// The candidates that a kind of skeleton keeps because of what they separate: 2-isthmuses for
// kSurface, 1-isthmuses for kIsthmusCurve. Shapes and result as MarkRemovable().
size_t MarkIsthmuses(const ObjectView& view, Sublattice sublattice, SkeletonKind kind,
                     std::span<const BrickIndex> bricks, MarkedBrick* marked);

// The data of the steps of rule B. All arrays have an element for each brick and one for the
// padding brick, which stays empty, as do those of bricks that are in no list.
struct RuleBView {
  ObjectView object;
  // The set S, its points that remain after pairs, and those that remain after triples.
  BrickBits* simple = nullptr;
  BrickBits* after_pairs = nullptr;
  BrickBits* after_triples = nullptr;
  const DepthPlanes* depth = nullptr;  // quarters of a lattice unit modulo 32
  // Whether points of a brick may be in critical cliques larger than pairs; rarely true.
  uint8_t* larger_cliques = nullptr;
  DirtyMask* dirty = nullptr;  // bricks to visit again, since points were unmarked
  int32_t pass = 0;
};

// The three steps, for bricks of one sublattice. In each, the points of a worker depend on the
// results of others in the step before. The last two skip bricks without larger cliques, which the
// first one marks.
// Shapes: `marked` has room for bricks.size().
// Returns: how many bricks have marks; they come in the order of `bricks`.
size_t SendBackFromPairs(const RuleBView& view, Sublattice sublattice,
                         std::span<const BrickIndex> bricks, MarkedBrick* marked);
void SendBackFromTriples(const RuleBView& view, Sublattice sublattice,
                         std::span<const BrickIndex> bricks);
size_t SendBackFromQuadruples(const RuleBView& view, Sublattice sublattice,
                              std::span<const BrickIndex> bricks, MarkedBrick* marked);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_MARK_SYMMETRIC_H_
