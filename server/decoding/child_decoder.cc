#include "server/decoding/child_decoder.h"

#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel::server {

absl::StatusOr<std::unique_ptr<VolumeDecoder>> ChildDecoder::Create(const VolumeHeader& header,
                                                                    const VolumeLimits& limits,
                                                                    const std::string& tenant,
                                                                    ChildPool& pool) {
  BCCSKEL_ASSIGN_OR_RETURN(SharedBytes bytes, SharedBytes::Create());
  return std::unique_ptr<VolumeDecoder>(
      new ChildDecoder(header, limits, tenant, pool, std::move(bytes)));
}

absl::Status ChildDecoder::Append(std::span<const std::byte> bytes) {
  if (bytes.size() > header_.max_encoded_bytes - bytes_.size()) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "more than %d bytes for an OpenEXR volume of %d x %d x %d cells", header_.max_encoded_bytes,
        header_.extent.nx, header_.extent.ny, header_.extent.nz));
  }
  return bytes_.Append(bytes);
}

absl::StatusOr<Volume> ChildDecoder::Finish(const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(bytes_.Seal());
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<ChildProcess> child, pool_.Take(tenant_));
  absl::StatusOr<Volume> volume = child->Decode(bytes_, header_, limits_, context);
  if (volume.ok()) pool_.Keep(tenant_, std::move(child));
  child.reset();
  pool_.StartAhead();
  return volume;
}

}  // namespace bccskel::server
