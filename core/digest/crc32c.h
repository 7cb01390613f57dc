#ifndef BCCSKEL_CORE_DIGEST_CRC32C_H_
#define BCCSKEL_CORE_DIGEST_CRC32C_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace bccskel {

// CRC-32C (Castagnoli, RFC 3720) of the bytes. `before` is that of what precedes them; the result
// is then that of both together.
// Cost: about 10 GB/s where the processor has an instruction for it, else 1 GB/s or more.
uint32_t Crc32c(std::span<const std::byte> bytes, uint32_t before = 0);
inline uint32_t Crc32c(std::string_view bytes, uint32_t before = 0) {
  return Crc32c(std::as_bytes(std::span(bytes)), before);
}

// Without that instruction; the same value. For tests.
uint32_t PlainCrc32c(std::span<const std::byte> bytes, uint32_t before = 0);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DIGEST_CRC32C_H_
