#ifndef BCCSKEL_CORE_PRUNING_CUT_FACES_H_
#define BCCSKEL_CORE_PRUNING_CUT_FACES_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/exec/memory_budget.h"
#include "core/lattice/lattice_point.h"
#include "core/prepare/beyond_border.h"
#include "core/volume/volume.h"

namespace bccskel {

// Finds the faces of an image that cut limbs off: there the object continues beyond the border.
// They are those where cuts across limbs make at least half of the object's voxels. A cut is a part
// of the face that is at most twice as wide as thick, that stays about as large over the first
// voxels of the image, and from whose middle a straight way leads into the object, at least 1.2
// times as long as its longest half-width. So a body that only touches a face, as in a tight crop,
// has no cut there, nor has a limb that lies along a face. `image`: the box of the image's
// outermost lattice points. `cells`: edges of the cubic cell along an edge of a voxel. Needs: an
// exact conversion of a mask. Errors: of the budget, CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<ImageFaces> FacesThatCutLimbs(const Volume& object, const LatticeBox& image,
                                             int32_t cells, exec::MemoryBudget& memory,
                                             const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_CUT_FACES_H_
