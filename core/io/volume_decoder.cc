#include "core/io/volume_decoder.h"

#include "core/exec/status_macros.h"
#include "core/io/volume_decoders.h"

namespace bccskel {

absl::StatusOr<std::unique_ptr<VolumeDecoder>> MakeVolumeDecoder(const VolumeHeader& header,
                                                                 const VolumeLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(const VolumeHeader checked, CompleteVolumeHeader(header, limits));
  switch (checked.encoding) {
    case VolumeEncoding::kOpenExr:
      return MakeExrDecoder(checked, limits);
    case VolumeEncoding::kRawPlanes:
      return MakePlanesDecoder(checked);
    case VolumeEncoding::kBricks:
      return MakeBricksDecoder(checked, limits);
    case VolumeEncoding::kCubicMask:
      return MakeMaskDecoder(checked);
  }
  return absl::InvalidArgumentError("unknown volume encoding");
}

absl::StatusOr<Volume> DecodeVolume(VolumeEncoding encoding, std::span<const std::byte> bytes,
                                    const VolumeLimits& limits, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const VolumeHeader header, ScanVolumeHeader(encoding, bytes, limits));
  BCCSKEL_ASSIGN_OR_RETURN(const std::unique_ptr<VolumeDecoder> decoder,
                           MakeVolumeDecoder(header, limits));
  BCCSKEL_RETURN_IF_ERROR(decoder->Append(bytes));
  return decoder->Finish(context);
}

absl::StatusOr<Volume> DecodeVolume(VolumeEncoding encoding, std::string_view bytes,
                                    const VolumeLimits& limits, const exec::Context& context) {
  return DecodeVolume(encoding, std::as_bytes(std::span(bytes)), limits, context);
}

}  // namespace bccskel
