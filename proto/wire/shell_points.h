#ifndef BCCSKEL_PROTO_WIRE_SHELL_POINTS_H_
#define BCCSKEL_PROTO_WIRE_SHELL_POINTS_H_

#include <cstddef>
#include <vector>

#include "absl/status/statusor.h"
#include "bccskel/v1/skeletonization_service.pb.h"
#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"

namespace bccskel::wire {

// Rows per message: each has at most 15 bytes, so a message stays within 256 KiB.
inline constexpr size_t kMaxShellPointRows = 16384;

// The points in brick order, where differences are small; none for no points.
std::vector<v1::ShellPoints> ShellPointsMessages(int32_t shell, const Volume& points);

// Errors: DATA_LOSS for columns of different lengths and for coordinates outside any lattice.
absl::StatusOr<std::vector<LatticePoint>> PointsOf(const v1::ShellPoints& message);

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_SHELL_POINTS_H_
