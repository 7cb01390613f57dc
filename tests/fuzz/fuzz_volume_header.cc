// Any bytes as the front of a volume: an error, or a header whose numbers hold together and lie
// within the limits. Cheap, so that the fuzzer gets through the checks that keep decoders safe.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "core/io/volume_header.h"
#include "core/volume/volume.h"

namespace {

constexpr bccskel::VolumeLimits kLimits = {
    .max_extent_cells = 4096, .max_bricks = 1 << 16, .max_decoded_bytes = 64 << 20};

bool Holds(const bccskel::VolumeHeader& header) {
  return bccskel::CheckGrid(header.extent, header.placement).ok() &&
         header.max_bricks <= kLimits.max_bricks &&
         header.max_bricks <= bccskel::BoxBrickCount(header.extent) &&
         header.decoded_bytes <= kLimits.max_decoded_bytes &&
         header.DecodingBytes(header.max_encoded_bytes) < uint64_t{1} << 30;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::span front(reinterpret_cast<const std::byte*>(data), size);
  for (auto encoding : {bccskel::VolumeEncoding::kOpenExr, bccskel::VolumeEncoding::kBricks}) {
    const auto header = bccskel::ScanVolumeHeader(encoding, front, kLimits);
    if (header.ok() && !Holds(*header)) std::abort();
  }
  return 0;
}
