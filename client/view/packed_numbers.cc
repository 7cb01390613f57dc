#include "client/view/packed_numbers.h"

#include <zlib.h>

#include <algorithm>
#include <cstddef>

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

absl::StatusOr<std::string> Deflate(std::string_view bytes, const exec::Context& context) {
  constexpr size_t kMostAtOnce = size_t{1} << 19;  // about 20 ms
  z_stream stream = {};
  if (deflateInit(&stream, 6) != Z_OK) {
    return absl::ResourceExhaustedError("not enough memory to compress");
  }
  std::string packed;
  int code = Z_OK;
  while (code == Z_OK && !context.ShouldStop()) {
    const size_t count = std::min(kMostAtOnce, bytes.size()), used = packed.size();
    packed.resize(used + kMostAtOnce);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(count);
    stream.next_out = reinterpret_cast<Bytef*>(packed.data() + used);
    stream.avail_out = static_cast<uInt>(kMostAtOnce);
    code = deflate(&stream, count == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    bytes.remove_prefix(count - stream.avail_in);
    packed.resize(packed.size() - stream.avail_out);
  }
  deflateEnd(&stream);
  BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
  return packed;
}

absl::StatusOr<std::string> PackText(std::string_view text, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string packed, Deflate(text, context));
  return absl::Base64Escape(packed);
}

absl::StatusOr<std::string> PackNumbers(std::span<const uint32_t> numbers) {
  return PackText(DifferencesOf(numbers));
}

}  // namespace bccskel::view
