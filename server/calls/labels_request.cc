#include "server/calls/labels_request.h"

#include <algorithm>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "core/io/encoded_body.h"
#include "proto/wire/labels.h"
#include "proto/wire/options.h"
#include "server/calls/volume_fields.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {


absl::StatusOr<int> LabelBytesOf(v1::LabelType type, const std::string& field) {
  if (type == v1::LABEL_TYPE_UNSPECIFIED) return InvalidField(field, "must be set");
  const int bytes = wire::LabelBytesOf(type);
  if (bytes == 0) return InvalidField(field, absl::StrCat("unknown type ", int{type}));
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
  return CallError(Reason::kVolumeTooLarge, absl::StrCat(
                                              "the declared volume has ", bytes,
                                              " bytes of labels, the limit is ", limit), {.quota = "max_decoded_bytes"});
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
  const std::string field = "config.volume";
  LabelVolumeHeader header;
  BCCSKEL_ASSIGN_OR_RETURN(header.label_bytes, LabelBytesOf(volume.type(), field + ".type"));
  BCCSKEL_ASSIGN_OR_RETURN(header.compression,
                           CompressionOf(volume.compression(), field + ".compression"));
  BCCSKEL_ASSIGN_OR_RETURN(header.grid, GridOf(volume.extent(), volume.placement(), field));
  BCCSKEL_ASSIGN_OR_RETURN(header.adjacency,
                           AdjacencyOf(volume.mask_adjacency(), field + ".mask_adjacency"));
  BCCSKEL_ASSIGN_OR_RETURN(header.points,
                           VoxelPointsOf(volume.voxel_points(), field + ".voxel_points"));
  BCCSKEL_RETURN_IF_ERROR(CheckPromises(volume, header));
  header.max_voxels = volume.max_voxels();
  header.max_label_voxels = volume.max_label_voxels();
  header.max_runs = volume.max_runs();
  header.max_labels = volume.max_labels();
  return header;
}

}  // namespace

absl::StatusOr<LabelsRequest> LabelsRequestOf(const v1::SkeletonizeLabelsConfig& config,
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
