#ifndef BCCSKEL_CORE_PREPARE_BEYOND_BORDER_H_
#define BCCSKEL_CORE_PREPARE_BEYOND_BORDER_H_

#include <array>

#include "absl/status/statusor.h"
#include "core/distance/distance_field.h"
#include "core/exec/context.h"
#include "core/exec/memory_budget.h"
#include "core/volume/volume.h"

namespace bccskel {

// The border of an image: that of the lattice, or that of the image from which the lattice was
// made, whose last corner points lie on its faces.
enum class BorderPoints : uint8_t { kLastOfLattice, kLastCorners };

// Which faces of an image: the first and the last across x, y and z.
using ImageFaces = std::array<std::array<bool, 2>, 3>;
inline constexpr ImageFaces kNoFaces = {};
inline constexpr ImageFaces kAllFaces = {{{true, true}, {true, true}, {true, true}}};

// Whether the object leaves any point of its image out.
bool HasBackground(const Volume& object, BorderPoints border);
// The box of the image's outermost points, extended without limit beyond the other faces.
LatticeBox WindowOf(const LatticeExtent& extent, BorderPoints border, const ImageFaces& faces);

// Returns the object in the window of its image, with the points beyond these faces in its own
// bricks and the adjacent ones. Beyond the other faces lies background. If the object continues
// beyond all faces, an image without background would be infinitely deep, so the object ends at its
// border: the result has no window.
// Errors: of the budget.
absl::StatusOr<Volume> ContinueBeyond(const ImageFaces& faces, const Volume& object,
                                      BorderPoints border, exec::MemoryBudget& memory);

// Measures the distances of the object's points, a subset of `space`, in `space`.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<DistanceField> MeasureIn(const Volume& space, const Volume& object,
                                        DistanceKind kind, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_BEYOND_BORDER_H_
