#include "core/io/exr_decoder.h"

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/exr_reader.h"

namespace bccskel {

absl::Status ExrDecoder::Append(std::span<const std::byte> bytes) {
  if (bytes.size() > header_.max_encoded_bytes - file_.size()) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "more than %d bytes for an OpenEXR volume of %d x %d x %d cells", header_.max_encoded_bytes,
        header_.extent.nx, header_.extent.ny, header_.extent.nz));
  }
  file_.insert(file_.end(), bytes.begin(), bytes.end());
  return absl::OkStatus();
}

absl::StatusOr<Volume> ExrDecoder::Finish(const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const VolumeHeader found,
                           ScanVolumeHeader(VolumeEncoding::kOpenExr, file_, limits_));
  if (found != header_) {
    return absl::InvalidArgumentError(
        "the OpenEXR bytes have another header than the one announced");
  }
  return ReadExr(file_, limits_, context);
}

}  // namespace bccskel
