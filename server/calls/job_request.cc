#include "server/calls/job_request.h"

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "core/labels/convert_label.h"
#include "proto/wire/options.h"
#include "proto/wire/placement.h"
#include "server/calls/volume_fields.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {


absl::StatusOr<VolumeEncoding> EncodingOf(v1::VolumeEncoding encoding, const std::string& field) {
  switch (encoding) {
    case v1::VOLUME_ENCODING_OPENEXR:
      return VolumeEncoding::kOpenExr;
    case v1::VOLUME_ENCODING_RAW_PLANES:
      return VolumeEncoding::kRawPlanes;
    case v1::VOLUME_ENCODING_BRICKS:
      return VolumeEncoding::kBricks;
    case v1::VOLUME_ENCODING_CUBIC_MASK:
      return VolumeEncoding::kCubicMask;
    case v1::VOLUME_ENCODING_UNSPECIFIED:
      return InvalidField(field, "must be set");
    default:
      return InvalidField(field, absl::StrCat("unknown encoding ", int{encoding}));
  }
}

absl::StatusOr<std::optional<VolumeEncoding>> ThinVolumeOf(v1::ThinVolumeReturn thin) {
  switch (thin) {
    case v1::THIN_VOLUME_RETURN_UNSPECIFIED:
    case v1::THIN_VOLUME_RETURN_OMIT:
      return std::nullopt;
    case v1::THIN_VOLUME_RETURN_OPENEXR:
      return VolumeEncoding::kOpenExr;
    case v1::THIN_VOLUME_RETURN_BRICKS:
      return VolumeEncoding::kBricks;
    default:
      return InvalidField("config.thin_volume_return", absl::StrCat("unknown ", int{thin}));
  }
}

absl::StatusOr<ShellPointsWanted> ShellPointsOf(v1::ShellPointsReturn shell_points) {
  switch (shell_points) {
    case v1::SHELL_POINTS_RETURN_UNSPECIFIED:
    case v1::SHELL_POINTS_RETURN_OMIT:
      return ShellPointsWanted::kNone;
    case v1::SHELL_POINTS_RETURN_ALL:
      return ShellPointsWanted::kAll;
    default:
      return InvalidField("config.shell_points_return",
                          absl::StrCat("unknown ", int{shell_points}));
  }
}

// A job that is not durable always ends with its stream.
absl::Status CheckDisconnectPolicy(v1::DisconnectPolicy policy) {
  if (v1::DisconnectPolicy_IsValid(policy)) return absl::OkStatus();
  return InvalidField("config.on_disconnect", absl::StrCat("unknown ", int{policy}));
}

// The compression whose decoder needs the most memory stands for those that a volume's own bytes
// name later.
VolumeCompression ReservedCompression(VolumeEncoding encoding, VolumeCompression declared) {
  switch (encoding) {
    case VolumeEncoding::kOpenExr:
      return VolumeCompression::kZip;
    case VolumeEncoding::kRawPlanes:
    case VolumeEncoding::kCubicMask:
      return declared;
    case VolumeEncoding::kBricks:
      return VolumeCompression::kZstd;
  }
  return declared;
}

// What the core finds wrong with a declaration, with the details that a caller gets.
absl::Status DeclarationError(const absl::Status& status) {
  if (!absl::IsResourceExhausted(status)) {
    return InvalidField("config.volume", std::string(status.message()));
  }
  return CallError(Reason::kVolumeTooLarge, std::string(status.message()), {.quota = "max_bricks"});
}

// A mask declares its voxels where other encodings declare their lattice.
absl::Status DeclareMask(const v1::VolumeDeclaration& volume, const std::string& field,
                         VolumeHeader& header) {
  MaskDeclaration mask;
  BCCSKEL_ASSIGN_OR_RETURN(mask.grid, GridOf(volume.extent(), volume.placement(), field));
  BCCSKEL_ASSIGN_OR_RETURN(mask.adjacency,
                           AdjacencyOf(volume.mask_adjacency(), field + ".mask_adjacency"));
  BCCSKEL_ASSIGN_OR_RETURN(mask.points,
                           VoxelPointsOf(volume.voxel_points(), field + ".voxel_points"));
  header.extent = ExactExtent(mask.grid, mask.points);
  header.placement = ExactPlacement(mask.grid, mask.points);
  header.mask = mask;
  return absl::OkStatus();
}

absl::StatusOr<VolumeHeader> HeaderOf(const v1::VolumeDeclaration& volume,
                                      const VolumeLimits& limits) {
  const std::string field = "config.volume";
  VolumeHeader header;
  BCCSKEL_ASSIGN_OR_RETURN(header.encoding, EncodingOf(volume.encoding(), field + ".encoding"));
  BCCSKEL_ASSIGN_OR_RETURN(const VolumeCompression compression,
                           CompressionOf(volume.compression(), field + ".compression"));
  header.compression = ReservedCompression(header.encoding, compression);
  BCCSKEL_ASSIGN_OR_RETURN(header.extent, wire::FromMessage(volume.extent(), field + ".extent"));
  BCCSKEL_ASSIGN_OR_RETURN(header.placement,
                           wire::FromMessage(volume.placement(), field + ".placement"));
  if (volume.max_bricks() > 0) header.declared_bricks = volume.max_bricks();
  if (header.encoding == VolumeEncoding::kBricks && !header.declared_bricks.has_value()) {
    return InvalidField(field + ".max_bricks", "0, must be the number of bricks");
  }
  if (header.encoding == VolumeEncoding::kCubicMask) {
    BCCSKEL_RETURN_IF_ERROR(DeclareMask(volume, field, header));
  }
  absl::StatusOr<VolumeHeader> complete = CompleteVolumeHeader(header, limits);
  if (!complete.ok()) return DeclarationError(complete.status());
  return complete;
}

absl::Status CheckSize(const VolumeHeader& header, uint64_t size_bytes) {
  if (size_bytes == 0) return InvalidField("config.volume.size_bytes", "must be set");
  if (size_bytes <= header.max_encoded_bytes) return absl::OkStatus();
  return InvalidField("config.volume.size_bytes",
                      absl::StrCat(size_bytes, " bytes, a volume of this extent and encoding has ",
                                   header.max_encoded_bytes, " at most"));
}

}  // namespace

absl::StatusOr<JobRequest> JobRequestOf(const v1::SkeletonizeConfig& config,
                                        const VolumeLimits& limits) {
  JobRequest request;
  BCCSKEL_ASSIGN_OR_RETURN(request.header, HeaderOf(config.volume(), limits));
  BCCSKEL_RETURN_IF_ERROR(CheckSize(request.header, config.volume().size_bytes()));
  request.size_bytes = config.volume().size_bytes();
  BCCSKEL_ASSIGN_OR_RETURN(request.options, wire::FromMessage(config.options(), "config.options"));
  if (request.header.mask.has_value()) {
    request.options = ForMask(request.options, {.points = request.header.mask->points});
  }
  BCCSKEL_ASSIGN_OR_RETURN(request.thin_volume, ThinVolumeOf(config.thin_volume_return()));
  BCCSKEL_ASSIGN_OR_RETURN(request.shell_points, ShellPointsOf(config.shell_points_return()));
  BCCSKEL_RETURN_IF_ERROR(CheckDisconnectPolicy(config.on_disconnect()));
  BCCSKEL_RETURN_IF_ERROR(CheckThreads(config.threads(), "config.threads"));
  request.threads_wanted = config.threads();
  return request;
}

}  // namespace bccskel::server
