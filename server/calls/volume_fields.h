#ifndef BCCSKEL_SERVER_CALLS_VOLUME_FIELDS_H_
#define BCCSKEL_SERVER_CALLS_VOLUME_FIELDS_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "bccskel/v1/volume.pb.h"
#include "core/io/volume_header.h"
#include "core/mask/mask_grid.h"

namespace bccskel::server {

// Fields that every config or declaration of a volume has. `field` is a field's path in its
// request, for the error's BadRequest.
// Errors: INVALID_ARGUMENT for an unknown enumerator and for numbers out of range.
absl::StatusOr<VolumeCompression> CompressionOf(v1::VolumeCompression compression,
                                                const std::string& field);
absl::StatusOr<MaskAdjacency> AdjacencyOf(v1::MaskAdjacency adjacency, const std::string& field);
absl::StatusOr<VoxelPoints> VoxelPointsOf(v1::VoxelPoints points, const std::string& field);
absl::StatusOr<MaskGrid> GridOf(const v1::LatticeExtent& extent, const v1::Placement& placement,
                                const std::string& field);
absl::Status CheckThreads(int32_t threads, const std::string& field);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_VOLUME_FIELDS_H_
