#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_TOPOLOGY_REPAIR_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_TOPOLOGY_REPAIR_H_

#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel {

// Along a sharp edge a solid is thinner than a cell at any spacing, so some of the points there
// hang together by chance, and loops and cavities appear that the solid does not have. Does:  takes
// the majority of each point's neighborhood, once or twice, which clears such edges and
//        thin parts with them; then gives back every point of the sampling, and takes away every
//        other one, as long as each is simple at its turn. So topology is that of the majority, and
//        all else, to a few points, that of the sampling.
// Takes the majority that is nearest to the wanted topology. Returns the sampling where none is
// nearer than that or each lacks a loop, and where the sampling itself lacks something.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<Volume> RepairTopology(Volume sampling, const BettiNumbers& found,
                                      const BettiNumbers& wanted, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_TOPOLOGY_REPAIR_H_
