#ifndef BCCSKEL_SERVER_STORE_LITTLE_ENDIAN_H_
#define BCCSKEL_SERVER_STORE_LITTLE_ENDIAN_H_

#include <cstdint>
#include <string>
#include <string_view>

namespace bccskel::server {

template <typename Unsigned>
void AppendNumber(Unsigned value, std::string& bytes) {
  for (size_t n = 0; n < sizeof(Unsigned); ++n) {
    bytes.push_back(static_cast<char>(static_cast<uint8_t>(value >> (8 * n))));
  }
}

// Needs: the bytes are there.
template <typename Unsigned>
Unsigned NumberAt(std::string_view bytes, size_t offset) {
  uint64_t value = 0;
  for (size_t n = 0; n < sizeof(Unsigned); ++n) {
    value |= uint64_t{static_cast<uint8_t>(bytes[offset + n])} << (8 * n);
  }
  return static_cast<Unsigned>(value);
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_LITTLE_ENDIAN_H_
