#include "core/digest/crc32c.h"

#include <array>

namespace bccskel {
namespace {

constexpr uint32_t kPolynomial = 0x82F63B78;  // reflected
constexpr size_t kSlices = 8;

using Tables = std::array<std::array<uint32_t, 256>, kSlices>;

constexpr uint32_t Shift(uint32_t crc) { return (crc >> 1) ^ ((crc & 1) != 0 ? kPolynomial : 0); }

// tables[n][b]: the contribution of byte b to the CRC if n more bytes follow.
constexpr Tables MakeTables() {
  Tables tables = {};
  for (uint32_t byte = 0; byte < 256; ++byte) {
    uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = Shift(crc);
    tables[0][byte] = crc;
  }
  for (size_t slice = 1; slice < kSlices; ++slice) {
    for (size_t byte = 0; byte < 256; ++byte) {
      const uint32_t crc = tables[slice - 1][byte];
      tables[slice][byte] = (crc >> 8) ^ tables[0][crc & 0xFF];
    }
  }
  return tables;
}
constexpr Tables kTables = MakeTables();

uint64_t LoadWord(const std::byte* bytes) {
  uint64_t word = 0;
  for (size_t n = 0; n < sizeof(word); ++n) word |= static_cast<uint64_t>(bytes[n]) << (8 * n);
  return word;
}

uint32_t PlainWord(uint32_t crc, uint64_t word) {
  word ^= crc;
  uint32_t next = 0;
  for (size_t n = 0; n < kSlices; ++n) next ^= kTables[kSlices - 1 - n][(word >> (8 * n)) & 0xFF];
  return next;
}

uint32_t PlainByte(uint32_t crc, std::byte byte) {
  return (crc >> 8) ^ kTables[0][(crc ^ static_cast<uint32_t>(byte)) & 0xFF];
}

#if defined(__x86_64__)
__attribute__((target("sse4.2"))) uint32_t FastCrc32c(std::span<const std::byte> bytes,
                                                      uint32_t before) {
  uint64_t crc = ~before;
  for (; bytes.size() >= sizeof(uint64_t); bytes = bytes.subspan(sizeof(uint64_t))) {
    crc = __builtin_ia32_crc32di(crc, LoadWord(bytes.data()));
  }
  auto rest = static_cast<uint32_t>(crc);
  for (const std::byte byte : bytes) {
    rest = __builtin_ia32_crc32qi(rest, static_cast<uint8_t>(byte));
  }
  return ~rest;
}
#endif

}  // namespace

uint32_t PlainCrc32c(std::span<const std::byte> bytes, uint32_t before) {
  uint32_t crc = ~before;
  for (; bytes.size() >= kSlices; bytes = bytes.subspan(kSlices)) {
    crc = PlainWord(crc, LoadWord(bytes.data()));
  }
  for (const std::byte byte : bytes) crc = PlainByte(crc, byte);
  return ~crc;
}

uint32_t Crc32c(std::span<const std::byte> bytes, uint32_t before) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("sse4.2")) return FastCrc32c(bytes, before);
#endif
  return PlainCrc32c(bytes, before);
}

}  // namespace bccskel
