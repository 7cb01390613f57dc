// Any bytes as an encoded volume: an error or a volume, the same whole and in parts; never a crash.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <utility>

#include "core/io/volume_decoder.h"
#include "core/io/volume_header.h"

namespace {

constexpr bccskel::VolumeLimits kLimits = {
    .max_extent_cells = 4096, .max_bricks = 1 << 16, .max_decoded_bytes = 64 << 20};

absl::StatusOr<bccskel::Volume> DecodeInTwoParts(bccskel::VolumeEncoding encoding,
                                                 std::span<const std::byte> bytes) {
  const auto header = bccskel::ScanVolumeHeader(encoding, bytes, kLimits);
  if (!header.ok()) return header.status();
  const auto decoder = bccskel::MakeVolumeDecoder(*header, kLimits);
  if (!decoder.ok()) return decoder.status();
  const auto [first, second] =
      std::pair(bytes.first(bytes.size() / 3), bytes.subspan(bytes.size() / 3));
  for (const auto part : {first, second}) {
    if (const auto status = (*decoder)->Append(part); !status.ok()) return status;
  }
  return (*decoder)->Finish();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
  const auto encoding = bccskel::SniffVolumeEncoding(bytes);
  if (!encoding.ok()) return 0;
  const auto whole = bccskel::DecodeVolume(*encoding, bytes, kLimits);
  const auto parts = DecodeInTwoParts(*encoding, bytes);
  if (whole.ok() != parts.ok()) std::abort();
  if (!whole.ok()) return 0;
  if (*whole != *parts) std::abort();
  return 0;
}
