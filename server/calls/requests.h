#ifndef BCCSKEL_SERVER_CALLS_REQUESTS_H_
#define BCCSKEL_SERVER_CALLS_REQUESTS_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "bccskel/v1/skeletonization_service.pb.h"
#include "bccskel/v1/volume.pb.h"
#include "core/io/volume_header.h"
#include "core/mask/mask_grid.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// Reads the first request of a stream. The deadline is left to the caller.
// Errors: INVALID_ARGUMENT with the field; RESOURCE_EXHAUSTED with the limit, for a volume declared
//         over `limits`.
absl::StatusOr<JobRequest> JobRequestOf(const v1::SkeletonizeConfig& config,
                                        const VolumeLimits& limits);

// Reads the first request of a stream of labels. The deadline is left to the caller.
// Errors: as JobRequestOf().
absl::StatusOr<LabelsRequest> JobRequestOf(const v1::SkeletonizeLabelsConfig& config,
                                           const VolumeLimits& limits);

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

#endif  // BCCSKEL_SERVER_CALLS_REQUESTS_H_
