#ifndef BCCSKEL_CORE_DISTANCE_EUCLIDEAN_PARTS_H_
#define BCCSKEL_CORE_DISTANCE_EUCLIDEAN_PARTS_H_

#include <algorithm>
#include <cstddef>

#include "core/distance/distance_field.h"
#include "core/distance/euclidean_rows.h"
#include "core/exec/context.h"
#include "core/exec/uninitialized.h"
#include "core/volume/volume.h"

// The two halves of the Euclidean distance, for objects that are too large for one machine: the
// first needs whole layers of bricks, the second whole columns, and between them the squares move.
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

// Right for the bricks of a layer if that layer and those above and below it are whole.
template <typename T>
void MeasureWithinLayers(const Volume& object, const exec::Context& context,
                         EuclideanParts<T>& parts);
// Needs: all bricks above and below each other are there, with both kinds of squares.
template <typename T>
void MeasureAcrossLayers(const Volume& object, const exec::Context& context,
                         EuclideanParts<T>& parts);
// Needs: MeasureAcrossLayers(). 16 bits are enough where largest() is below kFirstUnsureSquare.
template <typename T>
DistanceField EuclideanFieldOf(EuclideanParts<T> parts);

// Whether 16 bits are not worth a try.
bool IsDeep(const Volume& object);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EUCLIDEAN_PARTS_H_
