#ifndef BCCSKEL_CORE_PREPARE_BEYOND_BORDER_H_
#define BCCSKEL_CORE_PREPARE_BEYOND_BORDER_H_

#include "absl/status/statusor.h"
#include "core/distance/distance_field.h"
#include "core/exec/context.h"
#include "core/exec/memory_budget.h"
#include "core/prepare/brick_sets.h"
#include "core/volume/volume.h"

namespace bccskel {

// An object that is cut off at the border of its image, and what may lie beyond.
struct ContinuedObject {
  BrickCoordinates room;   // on all sides of the object, so that there are points beyond
  Volume object;           // shifted by that
  Volume space;            // with all points beyond the border that distances may need
  DistanceField distance;  // Euclidean, of the object's points to background within the border
};

// Distances without background beyond the border: that of the lattice, or of the image that it was
// made from, whose last corner points lie on its faces.
// Does:  adds the points beyond, farther and farther out, until no point of the object is deeper
//        than they reach. Of an object without background all is deeper than that.
// Cost:  a distance field of object and points beyond, up to three for thick objects.
// Errors: of the budget; INVALID_ARGUMENT where an axis has no room for the points beyond;
//         CANCELLED, DEADLINE_EXCEEDED.
enum class BorderPoints : uint8_t { kLastOfLattice, kLastCorners };
absl::StatusOr<ContinuedObject> ContinueBeyondBorder(const Volume& object, BorderPoints border,
                                                     exec::MemoryBudget& memory,
                                                     const exec::Context& context);

// The distances of `part`, a subset of `whole`, from the `field` of `whole`.
DistanceField FieldOfPart(const Volume& part, const Volume& whole, const DistanceField& field);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_BEYOND_BORDER_H_
