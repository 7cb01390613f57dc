#include "server/calls/volume_fields.h"

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "proto/wire/placement.h"
#include "server/errors/call_error.h"

namespace bccskel::server {


absl::StatusOr<VolumeCompression> CompressionOf(v1::VolumeCompression compression,
                                                const std::string& field) {
  switch (compression) {
    case v1::VOLUME_COMPRESSION_UNSPECIFIED:
    case v1::VOLUME_COMPRESSION_NONE:
      return VolumeCompression::kNone;
    case v1::VOLUME_COMPRESSION_ZSTD:
      return VolumeCompression::kZstd;
    default:
      return InvalidField(field, absl::StrCat("unknown compression ", int{compression}));
  }
}

absl::StatusOr<MaskAdjacency> AdjacencyOf(v1::MaskAdjacency adjacency, const std::string& field) {
  switch (adjacency) {
    case v1::MASK_ADJACENCY_UNSPECIFIED:
    case v1::MASK_ADJACENCY_OBJECT_26:
      return MaskAdjacency::k26;
    case v1::MASK_ADJACENCY_OBJECT_6:
      return MaskAdjacency::k6;
    default:
      return InvalidField(field, absl::StrCat("unknown adjacency ", int{adjacency}));
  }
}

absl::StatusOr<VoxelPoints> VoxelPointsOf(v1::VoxelPoints points, const std::string& field) {
  switch (points) {
    case v1::VOXEL_POINTS_UNSPECIFIED:
    case v1::VOXEL_POINTS_TWO:
      return VoxelPoints::kTwo;
    case v1::VOXEL_POINTS_SIXTEEN:
      return VoxelPoints::kSixteen;
    default:
      return InvalidField(field, absl::StrCat("unknown number of points ", int{points}));
  }
}

absl::StatusOr<MaskGrid> GridOf(const v1::LatticeExtent& extent, const v1::Placement& placement,
                                const std::string& field) {
  BCCSKEL_ASSIGN_OR_RETURN(const LatticeExtent voxels,
                           wire::FromMessage(extent, field + ".extent"));
  MaskGrid grid = {.nx = voxels.nx, .ny = voxels.ny, .nz = voxels.nz};
  BCCSKEL_ASSIGN_OR_RETURN(grid.placement, wire::FromMessage(placement, field + ".placement"));
  if (absl::Status checked = CheckMaskGrid(grid); !checked.ok()) {
    return InvalidField(field + ".extent", std::string(checked.message()));
  }
  return grid;
}

absl::Status CheckThreads(int32_t threads, const std::string& field) {
  if (threads >= 0) return absl::OkStatus();
  return InvalidField(field, absl::StrCat(threads, ", must be at least 0"));
}

}  // namespace bccskel::server
