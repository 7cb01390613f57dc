#ifndef BCCSKEL_CORE_DISTANCE_EUCLIDEAN_PARTS_H_
#define BCCSKEL_CORE_DISTANCE_EUCLIDEAN_PARTS_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/distance/euclidean_rows.h"
#include "core/distance/side_runs.h"
#include "core/exec/context.h"
#include "core/exec/uninitialized.h"
#include "core/volume/volume.h"

// The two halves of the Euclidean distance transform, for callers that measure an object part by
// part. Along x the first half needs only side runs, so columns of bricks can be measured
// separately. If the layers of bricks are on several machines, squares are sent between the halves.
// T as in euclidean_rows.h.

namespace bccskel {

template <typename T>
struct EuclideanParts {
  explicit EuclideanParts(size_t bricks)
      : own((bricks + 1) * kBrickPoints), beside(bricks * kLayersBeside * kLayerPoints) {
    std::fill(own.end() - kBrickPoints, own.end(), T{0});  // the padding brick
  }
  // As in EuclideanView; `own` has the padding brick, too.
  exec::UninitializedVector<T> own;
  exec::UninitializedVector<T> beside;
};

// Some bricks of an object, renumbered, and how far the whole object extends beside their rows.
struct ObjectPart {
  Volume volume;
  SideRuns<uint32_t> runs;
};
// Needs: increasing `bricks`, with all bricks of the object that lie between two of them along x.
// Cost:  computes neither the neighbor table nor the runs of the whole object: beyond the part, it
//        walks through the adjacent bricks.
ObjectPart PartOf(const Volume& object, std::span<const BrickIndex> bricks,
                  const exec::Context& context);
// The side runs of the whole object.
SideRuns<uint32_t> SideRunsOf(const Volume& object, const exec::Context& context);

// Computes distances within layers.
// Shapes: `runs` beside the bricks of `object`, which may be a part of the object in which they
//         were found. Results are right for the `wanted` bricks, which make up whole layers, if
//         these and the layers below and above them are whole along y; others are undefined.
template <typename T>
void MeasureWithinLayers(const Volume& object, exec::Share wanted, const SideRuns<uint32_t>& runs,
                         const exec::Context& context, EuclideanParts<T>& parts);
// Computes distances across layers. Calls `done` with stacks of bricks whose squares are final, on
// several workers at once. Returns the largest square; 16 bits are enough if it is below
// kFirstUnsureSquare.
// Needs: all bricks of each column along z, with both kinds of squares.
template <typename T>
float MeasureAcrossLayers(const Volume& object, const exec::Context& context,
                          EuclideanParts<T>& parts, const std::function<void(BrickStack)>& done);

// The number of bricks at each bx.
std::vector<uint64_t> BricksAtX(const Volume& object);
// The bricks of an object in groups of whole columns: all bricks of one bx are in one group. A
// group ends where the sum of `counts` over its bx reaches `least`, whatever the object has there.
std::vector<std::vector<BrickIndex>> ColumnsOf(const Volume& object,
                                               std::span<const uint64_t> counts, size_t least);

// Whether these bricks are so deep that 16-bit squares would most likely overflow.
bool IsDeep(const Volume& object, std::span<const BrickIndex> bricks);
bool IsDeep(const Volume& object);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EUCLIDEAN_PARTS_H_
