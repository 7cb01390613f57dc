#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_TOPOLOGY_REPAIR_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_TOPOLOGY_REPAIR_H_

#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel {

// Repairs what chance makes of thin parts. Along a sharp edge, and where a mesh crosses itself, a
// solid is thinner than a cell at any spacing, so some of the points there hang together by chance,
// and loops and cavities appear that the solid does not have.
// Does:   takes the majority of each point's neighborhood, up to four times, which clears such
//         edges and thin parts with them; then gives back every point of the sampling, and takes
//         away every other one, as long as each is simple at its turn. So topology is that of the
//         majority, and all else, to a few points, that of the sampling.
// Takes the majority with the fewest components, loops and cavities above the wanted numbers. None
// is taken that has fewer of them than the sampling and than wanted: parts that touch may lack
// components, and walls thinner than a cell loops. Returns the sampling where none is better, or
// where a 16th of the points would go.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<Volume> RepairTopology(Volume sampling, const BettiNumbers& found,
                                      const BettiNumbers& wanted, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_TOPOLOGY_REPAIR_H_
