#include "core/io/volume_encoder.h"

#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_writers.h"

namespace bccskel {
namespace {

absl::Status CheckDenseBytes(const LatticeExtent& extent, const EncodeVolumeOptions& options) {
  const uint64_t bytes = DensePlaneBytes(extent);
  if (bytes <= options.max_dense_bytes) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "extent of %d x %d x %d cells is %d bytes dense: %s is limited to %d; write it as bricks "
      "(.bccb), whose size follows the object",
      extent.nx, extent.ny, extent.nz, bytes, VolumeEncodingName(options.encoding),
      options.max_dense_bytes));
}

}  // namespace

absl::Status EncodeVolumeTo(const Volume& volume, const EncodeVolumeOptions& options,
                            ByteSink& sink, const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckGrid(volume.extent(), volume.placement()));
  BCCSKEL_RETURN_IF_ERROR(CheckCompression(options.encoding, options.compression));
  switch (options.encoding) {
    case VolumeEncoding::kOpenExr:
      BCCSKEL_RETURN_IF_ERROR(CheckDenseBytes(volume.extent(), options));
      return WriteExr(volume, options.compression, sink, context);
    case VolumeEncoding::kRawPlanes:
      BCCSKEL_RETURN_IF_ERROR(CheckDenseBytes(volume.extent(), options));
      return WritePlanes(volume, options.compression, sink, context);
    case VolumeEncoding::kBricks:
      return WriteBricks(volume, options.compression, sink, context);
    case VolumeEncoding::kCubicMask:
      return absl::InvalidArgumentError("a bcc volume cannot be written as a cubic mask");
  }
  return absl::InvalidArgumentError("unknown volume encoding");
}

absl::StatusOr<std::string> EncodeVolume(const Volume& volume, const EncodeVolumeOptions& options,
                                         const exec::Context& context) {
  StringSink sink;
  BCCSKEL_RETURN_IF_ERROR(EncodeVolumeTo(volume, options, sink, context));
  return std::move(sink).Take();
}

}  // namespace bccskel
