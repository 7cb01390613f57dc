#include "client/view/packed_numbers.h"

#include <zlib.h>

#include "absl/strings/escaping.h"
#include "core/exec/status_macros.h"

namespace bccskel::view {
namespace {

// 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
uint64_t Zigzag(int64_t value) {
  return static_cast<uint64_t>(value) << 1 ^ static_cast<uint64_t>(value >> 63);
}

std::string DifferencesOf(std::span<const uint32_t> numbers) {
  std::string bytes;
  int64_t before = 0;
  for (const uint32_t number : numbers) {
    uint64_t rest = Zigzag(number - before);
    for (; rest >= 128; rest >>= 7) bytes.push_back(static_cast<char>(rest | 128));
    bytes.push_back(static_cast<char>(rest));
    before = number;
  }
  return bytes;
}

}  // namespace

absl::StatusOr<std::string> Deflate(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  const int code = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                             reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 6);
  if (code != Z_OK) return absl::ResourceExhaustedError("not enough memory to compress");
  packed.resize(size);
  return packed;
}

absl::StatusOr<std::string> PackText(std::string_view text) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string packed, Deflate(text));
  return absl::Base64Escape(packed);
}

absl::StatusOr<std::string> PackNumbers(std::span<const uint32_t> numbers) {
  return PackText(DifferencesOf(numbers));
}

}  // namespace bccskel::view
