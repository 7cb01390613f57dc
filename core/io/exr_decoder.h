#ifndef BCCSKEL_CORE_IO_EXR_DECODER_H_
#define BCCSKEL_CORE_IO_EXR_DECODER_H_

#include <vector>

#include "core/io/volume_decoder.h"

namespace bccskel {

// OpenEXR needs the whole file: its chunks may lie in any order behind the tables.
class ExrDecoder final : public VolumeDecoder {
 public:
  ExrDecoder(const VolumeHeader& header, const VolumeLimits& limits)
      : header_(header), limits_(limits) {}

  absl::Status Append(std::span<const std::byte> bytes) override;
  absl::StatusOr<Volume> Finish(const exec::Context& context) override;

 private:
  VolumeHeader header_;
  VolumeLimits limits_;
  std::vector<std::byte> file_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_EXR_DECODER_H_
