#include "server/calls/requests.h"

#include <algorithm>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "core/io/encoded_body.h"
#include "core/labels/convert_label.h"
#include "core/mask/mask_grid.h"
#include "proto/wire/labels.h"
#include "proto/wire/options.h"
#include "proto/wire/placement.h"
#include "proto/wire/volume_encoding.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

absl::StatusOr<VolumeEncoding> EncodingOf(v1::VolumeEncoding encoding) {
  if (encoding == v1::VOLUME_ENCODING_UNSPECIFIED)
    return InvalidField("config.volume.encoding", "must be set");
  return MeaningOf<VolumeEncoding>(encoding, "config.volume.encoding", "encoding ",
                                   wire::kVolumeEncodings);
}

absl::StatusOr<VolumeCompression> CompressionOf(v1::VolumeCompression compression) {
  return MeaningOf<VolumeCompression>(
      compression, "config.volume.compression", "compression ",
      {{v1::VOLUME_COMPRESSION_UNSPECIFIED, VolumeCompression::kNone},
       {v1::VOLUME_COMPRESSION_NONE, VolumeCompression::kNone},
       {v1::VOLUME_COMPRESSION_ZSTD, VolumeCompression::kZstd}});
}

absl::StatusOr<MaskAdjacency> AdjacencyOf(v1::MaskAdjacency adjacency) {
  return MeaningOf<MaskAdjacency>(adjacency, "config.volume.mask_adjacency", "adjacency ",
                                  {{v1::MASK_ADJACENCY_UNSPECIFIED, MaskAdjacency::k26},
                                   {v1::MASK_ADJACENCY_OBJECT_26, MaskAdjacency::k26},
                                   {v1::MASK_ADJACENCY_OBJECT_6, MaskAdjacency::k6}});
}

absl::StatusOr<VoxelPoints> VoxelPointsOf(v1::VoxelPoints points) {
  return MeaningOf<VoxelPoints>(points, "config.volume.voxel_points", "number of points ",
                                {{v1::VOXEL_POINTS_UNSPECIFIED, VoxelPoints::kTwo},
                                 {v1::VOXEL_POINTS_TWO, VoxelPoints::kTwo},
                                 {v1::VOXEL_POINTS_SIXTEEN, VoxelPoints::kSixteen}});
}

absl::StatusOr<std::optional<VolumeEncoding>> ThinVolumeOf(v1::ThinVolumeReturn thin) {
  return MeaningOf<std::optional<VolumeEncoding>>(
      thin, "config.thin_volume_return", "",
      {{v1::THIN_VOLUME_RETURN_UNSPECIFIED, std::nullopt},
       {v1::THIN_VOLUME_RETURN_OMIT, std::nullopt},
       {v1::THIN_VOLUME_RETURN_OPENEXR, VolumeEncoding::kOpenExr},
       {v1::THIN_VOLUME_RETURN_BRICKS, VolumeEncoding::kBricks}});
}

absl::StatusOr<ShellPointsWanted> ShellPointsOf(v1::ShellPointsReturn shell_points) {
  return MeaningOf<ShellPointsWanted>(
      shell_points, "config.shell_points_return", "",
      {{v1::SHELL_POINTS_RETURN_UNSPECIFIED, ShellPointsWanted::kNone},
       {v1::SHELL_POINTS_RETURN_OMIT, ShellPointsWanted::kNone},
       {v1::SHELL_POINTS_RETURN_ALL, ShellPointsWanted::kAll}});
}

absl::StatusOr<MaskGrid> GridOf(const v1::LatticeExtent& extent, const v1::Placement& placement) {
  BCCSKEL_ASSIGN_OR_RETURN(const LatticeExtent voxels,
                           wire::FromMessage(extent, "config.volume.extent"));
  MaskGrid grid = {.nx = voxels.nx, .ny = voxels.ny, .nz = voxels.nz};
  BCCSKEL_ASSIGN_OR_RETURN(grid.placement, wire::FromMessage(placement, "config.volume.placement"));
  if (absl::Status checked = CheckMaskGrid(grid); !checked.ok()) {
    return InvalidField("config.volume.extent", std::string(checked.message()));
  }
  return grid;
}

// A job that is not durable always ends with its stream.
absl::Status CheckDisconnectPolicy(v1::DisconnectPolicy policy) {
  if (v1::DisconnectPolicy_IsValid(policy)) return absl::OkStatus();
  return InvalidField("config.on_disconnect", absl::StrCat("unknown ", int{policy}));
}

// For formats whose bytes name the compression later: the compression whose decoder needs the most
// memory.
VolumeCompression ReservedCompression(VolumeEncoding encoding, VolumeCompression declared) {
  if (encoding == VolumeEncoding::kOpenExr) return VolumeCompression::kZip;
  return encoding == VolumeEncoding::kBricks ? VolumeCompression::kZstd : declared;
}

// Adds the details for callers to the core's error about a declaration.
absl::Status DeclarationError(const absl::Status& status) {
  if (!absl::IsResourceExhausted(status)) {
    return InvalidField("config.volume", std::string(status.message()));
  }
  return CallError(Reason::kVolumeTooLarge, std::string(status.message()), {.quota = "max_bricks"});
}

// A mask declares its voxels; other encodings declare their lattice.
absl::Status DeclareMask(const v1::VolumeDeclaration& volume, VolumeHeader& header) {
  MaskDeclaration mask;
  BCCSKEL_ASSIGN_OR_RETURN(mask.grid, GridOf(volume.extent(), volume.placement()));
  BCCSKEL_ASSIGN_OR_RETURN(mask.adjacency, AdjacencyOf(volume.mask_adjacency()));
  BCCSKEL_ASSIGN_OR_RETURN(mask.points, VoxelPointsOf(volume.voxel_points()));
  header.extent = ExactExtent(mask.grid, mask.points);
  header.placement = ExactPlacement(mask.grid, mask.points);
  header.mask = mask;
  // The caller counts blocks of voxels; a block has as many bricks as its voxels have slabs.
  const auto [sx, sy, sz] = SlabsOf(mask.grid, mask.points);
  if (header.declared_bricks.has_value()) {
    header.declared_bricks =
        SaturatingMultiply(*header.declared_bricks, static_cast<uint64_t>(sx * sy * sz));
  }
  return absl::OkStatus();
}

absl::StatusOr<VolumeHeader> HeaderOf(const v1::VolumeDeclaration& volume,
                                      const VolumeLimits& limits) {
  VolumeHeader header;
  BCCSKEL_ASSIGN_OR_RETURN(header.encoding, EncodingOf(volume.encoding()));
  BCCSKEL_ASSIGN_OR_RETURN(const VolumeCompression compression,
                           CompressionOf(volume.compression()));
  header.compression = ReservedCompression(header.encoding, compression);
  BCCSKEL_ASSIGN_OR_RETURN(header.extent,
                           wire::FromMessage(volume.extent(), "config.volume.extent"));
  BCCSKEL_ASSIGN_OR_RETURN(header.placement,
                           wire::FromMessage(volume.placement(), "config.volume.placement"));
  if (volume.max_bricks() > 0) header.declared_bricks = volume.max_bricks();
  if (header.encoding == VolumeEncoding::kBricks && !header.declared_bricks.has_value()) {
    return InvalidField("config.volume.max_bricks", "0, must be the number of bricks");
  }
  if (header.encoding == VolumeEncoding::kCubicMask) {
    BCCSKEL_RETURN_IF_ERROR(DeclareMask(volume, header));
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

absl::StatusOr<int> LabelBytesOf(v1::LabelType type) {
  if (type == v1::LABEL_TYPE_UNSPECIFIED) return InvalidField("config.volume.type", "must be set");
  const int bytes = wire::LabelBytesOf(type);
  if (bytes == 0)
    return InvalidField("config.volume.type", absl::StrCat("unknown type ", int{type}));
  return bytes;
}

absl::Status CheckPromise(const char* name, uint64_t promise, uint64_t most) {
  if (promise <= most) return absl::OkStatus();
  return InvalidField(absl::StrCat("config.volume.", name),
                      absl::StrCat(promise, ", must be at most ", most));
}

absl::Status CheckPromises(const v1::LabelVolumeDeclaration& volume,
                           const LabelVolumeHeader& header) {
  const uint64_t voxels = header.DecodedBytes() / static_cast<uint64_t>(header.label_bytes);
  BCCSKEL_RETURN_IF_ERROR(CheckPromise("max_voxels", volume.max_voxels(), voxels));
  return CheckPromise("max_label_voxels", volume.max_label_voxels(),
                      volume.max_voxels() > 0 ? volume.max_voxels() : voxels);
}

absl::Status CheckDecodedBytes(uint64_t bytes, uint64_t limit) {
  if (bytes <= limit) return absl::OkStatus();
  return CallError(
      Reason::kVolumeTooLarge,
      absl::StrCat("the declared volume has ", bytes, " bytes of labels, the limit is ", limit),
      {.quota = "max_decoded_bytes"});
}

absl::Status CheckSize(const LabelVolumeHeader& header, uint64_t size_bytes) {
  const uint64_t decoded = header.DecodedBytes();
  const uint64_t most = MaxBodyBytes(decoded, header.compression);
  const uint64_t least = header.compression == VolumeCompression::kNone ? decoded : 1;
  if (least <= size_bytes && size_bytes <= most) return absl::OkStatus();
  return InvalidField("config.volume.size_bytes",
                      absl::StrCat(size_bytes, ", must be ", least, " to ", most,
                                   " bytes for this extent, type and compression"));
}

absl::StatusOr<LabelVolumeHeader> HeaderOf(const v1::LabelVolumeDeclaration& volume) {
  LabelVolumeHeader header;
  BCCSKEL_ASSIGN_OR_RETURN(header.label_bytes, LabelBytesOf(volume.type()));
  BCCSKEL_ASSIGN_OR_RETURN(header.compression, CompressionOf(volume.compression()));
  BCCSKEL_ASSIGN_OR_RETURN(header.grid, GridOf(volume.extent(), volume.placement()));
  BCCSKEL_ASSIGN_OR_RETURN(header.adjacency, AdjacencyOf(volume.mask_adjacency()));
  BCCSKEL_ASSIGN_OR_RETURN(header.points, VoxelPointsOf(volume.voxel_points()));
  BCCSKEL_RETURN_IF_ERROR(CheckPromises(volume, header));
  header.max_voxels = volume.max_voxels();
  header.max_label_voxels = volume.max_label_voxels();
  header.max_runs = volume.max_runs();
  header.max_labels = volume.max_labels();
  return header;
}

}  // namespace

std::string DeclarationBytes(v1::VolumeDeclaration volume) {
  volume.DiscardUnknownFields();
  return volume.SerializeAsString();
}

absl::Status CheckThreads(int32_t threads, const std::string& field) {
  if (threads >= 0) return absl::OkStatus();
  return InvalidField(field, absl::StrCat(threads, ", must be at least 0"));
}

absl::StatusOr<JobRequest> JobRequestOf(const v1::SkeletonizeConfig& config,
                                        const VolumeLimits& limits) {
  JobRequest request;
  BCCSKEL_ASSIGN_OR_RETURN(request.header, HeaderOf(config.volume(), limits));
  BCCSKEL_RETURN_IF_ERROR(CheckSize(request.header, config.volume().size_bytes()));
  request.size_bytes = config.volume().size_bytes();
  BCCSKEL_ASSIGN_OR_RETURN(request.options, wire::FromMessage(config.options(), "config.options"));
  if (request.header.mask.has_value()) {
    const MaskDeclaration& mask = *request.header.mask;
    request.options = ForMask(request.options, mask.grid, {.points = mask.points});
  }
  BCCSKEL_ASSIGN_OR_RETURN(request.thin_volume, ThinVolumeOf(config.thin_volume_return()));
  BCCSKEL_ASSIGN_OR_RETURN(request.shell_points, ShellPointsOf(config.shell_points_return()));
  BCCSKEL_RETURN_IF_ERROR(CheckDisconnectPolicy(config.on_disconnect()));
  BCCSKEL_RETURN_IF_ERROR(CheckThreads(config.threads(), "config.threads"));
  request.threads_wanted = config.threads();
  return request;
}

absl::StatusOr<LabelsRequest> JobRequestOf(const v1::SkeletonizeLabelsConfig& config,
                                           const VolumeLimits& limits) {
  LabelsRequest request;
  BCCSKEL_ASSIGN_OR_RETURN(const LabelVolumeHeader header, HeaderOf(config.volume()));
  BCCSKEL_RETURN_IF_ERROR(CheckSize(header, config.volume().size_bytes()));
  BCCSKEL_RETURN_IF_ERROR(CheckDecodedBytes(header.DecodedBytes(), limits.max_decoded_bytes));
  request.size_bytes = config.volume().size_bytes();
  request.labels.assign(config.labels().begin(), config.labels().end());
  if (std::ranges::count(request.labels, uint64_t{0}) > 0) {
    return InvalidField("config.labels", "0 is the background and has no skeleton");
  }
  request.header = WithWorstCase(header, request.labels.size());
  request.min_voxels = config.min_voxels();
  BCCSKEL_ASSIGN_OR_RETURN(request.options, wire::FromMessage(config.options(), "config.options"));
  BCCSKEL_RETURN_IF_ERROR(CheckThreads(config.threads(), "config.threads"));
  request.threads_wanted = config.threads();
  return request;
}

}  // namespace bccskel::server
