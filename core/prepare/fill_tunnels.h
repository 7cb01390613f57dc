#ifndef BCCSKEL_CORE_PREPARE_FILL_TUNNELS_H_
#define BCCSKEL_CORE_PREPARE_FILL_TUNNELS_H_

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/exec/memory_budget.h"
#include "core/prepare/changed_volume.h"

namespace bccskel {

// In lattice units; a wider tunnel is not a flaw of a scan.
inline constexpr double kMaxTunnelWidth = 256;

// Does:  fills tunnels through which a ball of diameter `width` (lattice units) does not fit, with
//        the crevices beside them that it does not enter either; counts the loops removed.
// The closing by that ball, all points that it cannot reach from outside, consists of connected
// pieces. A piece is filled if that raises the Euler characteristic and it touches one component of
// the object and no cavity. Where pieces together would enclose background, as many stay open as
// connect it with the outside. So components and cavities stay, and each unit that the
// characteristic rises is one loop less. Narrow balls come first, each twice as wide as the last:
// the pieces of a wide ball join a tunnel to the crevices around it.
// Cost:  for each ball two Euclidean distance fields over the bricks around the object; for a small
//        one a visit to its points around each point of the surface; and two labelings of the
//        background.
// Errors: of the budget; CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<ChangedVolume> FillTunnels(const Volume& object, double width,
                                          exec::MemoryBudget& memory, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_FILL_TUNNELS_H_
