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

// The two halves of the Euclidean distance, for callers that measure an object part by part. Along
// x the first half needs only side runs, so columns of bricks can be measured separately; if the
// layers of bricks are on several machines, squares are sent between the halves.
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

// Some bricks of an object, numbered anew, and how far the whole object extends beside their rows.
struct ObjectPart {
  Volume volume;
  SideRuns<uint32_t> runs;
};
// Needs: increasing `bricks`, all that the object has between two of them along x.
// Cost:  no table of the object's neighbors, and no runs but the part's: where it ends, the bricks
//        beside it are walked through.
ObjectPart PartOf(const Volume& object, std::span<const BrickIndex> bricks,
                  const exec::Context& context);
// That of the whole object.
SideRuns<uint32_t> SideRunsOf(const Volume& object, const exec::Context& context);

// Shapes: `runs` beside the bricks of `object`, which may be a part of what they were found in.
// Right for the `wanted` bricks, which are those of whole layers, if these and the layers above and
// below them are whole along y; leaves the others undefined.
template <typename T>
void MeasureWithinLayers(const Volume& object, exec::Share wanted, const SideRuns<uint32_t>& runs,
                         const exec::Context& context, EuclideanParts<T>& parts);
// Calls `done` with stacks of bricks whose squares are final, on several workers at once. Returns
// the largest square: 16 bits are enough where that is below kFirstUnsureSquare. Needs: all bricks
// above and below each other are there, with both kinds of squares.
template <typename T>
float MeasureAcrossLayers(const Volume& object, const exec::Context& context,
                          EuclideanParts<T>& parts, const std::function<void(BrickStack)>& done);

// How many bricks an object has at each bx.
std::vector<uint64_t> BricksAtX(const Volume& object);
// The bricks of an object in groups of whole columns: those of a bx lie in one group. A group ends
// where the `counts` by bx of what it has add up to `least` or more, whatever the object has there.
std::vector<std::vector<BrickIndex>> ColumnsOf(const Volume& object,
                                               std::span<const uint64_t> counts, size_t least);

// Whether 16 bits are not worth a try for these bricks of the object.
bool IsDeep(const Volume& object, std::span<const BrickIndex> bricks);
bool IsDeep(const Volume& object);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EUCLIDEAN_PARTS_H_
