#ifndef BCCSKEL_CORE_DIGEST_SHA256_H_
#define BCCSKEL_CORE_DIGEST_SHA256_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace bccskel {

// The 32 bytes of a SHA-256 digest.
struct Sha256Digest {
  std::array<uint8_t, 32> bytes = {};

  // 64 lower case hexadecimal digits.
  std::string Hex() const;
  friend bool operator==(const Sha256Digest&, const Sha256Digest&) = default;
};

// SHA-256 (FIPS 180-4) of a message in parts. Numbers are added little-endian, so
// that a digest is the same on every machine.
// Threads: one at a time per object.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;

  void Add(std::span<const std::byte> bytes);
  void Add(std::string_view bytes) { Add(std::as_bytes(std::span(bytes))); }
  void AddUint64(uint64_t value) {
    std::array<std::byte, sizeof(value)> bytes;
    for (size_t n = 0; n < bytes.size(); ++n) bytes[n] = static_cast<std::byte>(value >> (8 * n));
    Add(bytes);
  }

  // The digest of everything added since the start or the last Finish(); starts a new message.
  Sha256Digest Finish();

 private:
  class State;  // keeps Nettle's header out of this one
  std::unique_ptr<State> state_;
};

Sha256Digest Sha256Of(std::span<const std::byte> bytes);
Sha256Digest Sha256Of(std::string_view bytes);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DIGEST_SHA256_H_
