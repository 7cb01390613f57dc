#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_THIN_PARTS_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_THIN_PARTS_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/import/voxelize/row_fill.h"
#include "core/volume/volume.h"

namespace bccskel {

// Whether parts of a solid that are thinner than the lattice resolves are kept whole.
enum class ThinParts { kKeep, kSample };

// Adds the lattice points that keep thin parts of a solid whole: fins, leaves, walls, the edges of
// blades, hairs and wires. Which of the points inside a part thinner than two lattice units is a
// matter of chance: they leave a comb with many teeth and tunnels, or nothing. Does:    finds the
// places where two nearly opposite sides of the surface are less than two units
//          apart, and adds the points within one unit of the middle between them. Two units are the
//          least thickness at which a slab of lattice points has no holes in any direction: no step
//          between neighbors is longer across it. Needles: see NeedlePoints().
// Leaves:  parts thinner than 1/16 unit, since surfaces that are folded onto themselves enclose
//          nothing; gaps, which may close.
// Needs:   `sampling` was filled from the request by winding number. `triangles`: how many of the
//          request's, from the first, are the surface; the others are caps.
// Cost:    about 20 ns per triangle; where the solid is thin, as much as FillRows() per axis.
// Errors:  RESOURCE_EXHAUSTED (more points than the request allows), CANCELLED, DEADLINE_EXCEEDED.
// Threads: same bits for any number of threads.
absl::StatusOr<Volume> WithThinParts(Volume sampling, const FillRequest& request, size_t triangles,
                                     const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_THIN_PARTS_H_
