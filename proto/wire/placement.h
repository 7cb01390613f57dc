#ifndef BCCSKEL_PROTO_WIRE_PLACEMENT_H_
#define BCCSKEL_PROTO_WIRE_PLACEMENT_H_

#include <string>

#include "absl/status/statusor.h"
#include "bccskel/v1/volume.pb.h"
#include "core/lattice/lattice_point.h"

namespace bccskel::wire {

v1::LatticeExtent ToMessage(const LatticeExtent& extent);
v1::Placement ToMessage(const Placement& placement);

// `field` is the message's path in its request, for the error's BadRequest.
// Errors: INVALID_ARGUMENT for an axis outside 1..kMaxExtentCells.
absl::StatusOr<LatticeExtent> FromMessage(const v1::LatticeExtent& message,
                                          const std::string& field);
// Missing arrays take the default. Errors: INVALID_ARGUMENT for a wrong number of values, values
// that are not finite, and spacings that are not positive.
absl::StatusOr<Placement> FromMessage(const v1::Placement& message, const std::string& field);

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_PLACEMENT_H_
