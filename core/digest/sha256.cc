#include "core/digest/sha256.h"

#include <algorithm>

namespace bccskel {
namespace {

constexpr Sha256State kStart = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
constexpr std::array<std::byte, kSha256Block> kPadding = {std::byte{0x80}};

}  // namespace

std::string Sha256Digest::Hex() const {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string hex;
  hex.reserve(2 * bytes.size());
  for (uint8_t byte : bytes) {
    hex.push_back(kDigits[byte >> 4]);
    hex.push_back(kDigits[byte & 15]);
  }
  return hex;
}

Sha256::Sha256() : state_(kStart) {}

void Sha256::Add(std::span<const std::byte> bytes) {
  size_t used = size_ % kSha256Block;
  size_ += bytes.size();
  if (used > 0) {
    const size_t count = std::min(bytes.size(), kSha256Block - used);
    std::ranges::copy(bytes.first(count), rest_.begin() + static_cast<ptrdiff_t>(used));
    bytes = bytes.subspan(count);
    used += count;
    if (used < kSha256Block) return;
    AddSha256Blocks(rest_, state_);
  }
  const size_t whole = bytes.size() - bytes.size() % kSha256Block;
  AddSha256Blocks(bytes.first(whole), state_);
  std::ranges::copy(bytes.subspan(whole), rest_.begin());
}

Sha256Digest Sha256::Finish() {
  const uint64_t bits = 8 * size_;
  const size_t length = sizeof(bits);
  const size_t used = (size_ + length) % kSha256Block;
  Add(std::span(kPadding).first(kSha256Block - used));
  std::array<std::byte, length> end;
  for (size_t n = 0; n < length; ++n) end[n] = static_cast<std::byte>(bits >> (56 - 8 * n));
  Add(end);
  Sha256Digest digest;
  for (size_t n = 0; n < digest.bytes.size(); ++n) {
    digest.bytes[n] = static_cast<uint8_t>(state_[n / 4] >> (24 - 8 * (n % 4)));
  }
  *this = Sha256();
  return digest;
}

Sha256Digest Sha256Of(std::span<const std::byte> bytes) {
  Sha256 sha;
  sha.Add(bytes);
  return sha.Finish();
}

Sha256Digest Sha256Of(std::string_view bytes) { return Sha256Of(std::as_bytes(std::span(bytes))); }

}  // namespace bccskel
