#ifndef BCCSKEL_CORE_PIPELINE_AT_BORDER_H_
#define BCCSKEL_CORE_PIPELINE_AT_BORDER_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "core/exec/memory_budget.h"
#include "core/lattice/lattice_point.h"
#include "core/pipeline/skeletonize.h"
#include "core/prepare/beyond_border.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/skeleton/thin_skeleton.h"
#include "core/volume/volume.h"

namespace bccskel {

// Which points lie on the border of the image.
BorderPoints LastPointsOf(ObjectSource source);

// The box of the image whose border cuts limbs off: of masks, and of anything that continues beyond
// it. An image of one slice cuts nothing off across the slice.
std::optional<LatticeBox> ImageThatCuts(const LatticeExtent& extent,
                                        const SkeletonizeOptions& options);

// Beyond which faces of its image an object continues, and how results state it.
struct BeyondFaces {
  ImageFaces faces = kNoFaces;
  Border stated = Border::kEnds;
};
// `border` is that of CanonicalOptions().
// Errors: of the budget, CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<BeyondFaces> FindFaces(const Volume& object, const SkeletonizeOptions& options,
                                      Border border, exec::MemoryBudget& memory,
                                      const exec::Context& context);

// Points of curves that lead to where the border of an image cuts limbs off (BorderTips). The
// border is no surface of these limbs, although it is background for everything else.

// Sets their radii as if the object continued across the axis of their cut.
// Shapes: `radii` has one value per point of `thin`, in the order of Volume::ForEachPoint().
// Needs:  an exact conversion of a mask.
// Errors: of the budget, CANCELLED, DEADLINE_EXCEEDED.
absl::Status MeasureAtBorder(const Volume& object, const SkeletonizeOptions& options,
                             const PointsByAxis& at_border, const Volume& thin,
                             exec::MemoryBudget& memory, const exec::Context& context,
                             std::vector<float>& radii);

// Takes back what CenterCurves() did with them: their curves are straight.
void DropShifts(const PointsByAxis& at_border, SkeletonGraph& graph);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_AT_BORDER_H_
