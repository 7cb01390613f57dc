#include "core/digest/sha256.h"

// Not OpenSSL: its digests load its configuration first or are deprecated, and loading takes as
// long as the skeleton of a small object.
#include <nettle/sha2.h>

namespace bccskel {

class Sha256::State {
 public:
  State() { sha256_init(&context_); }
  void Add(std::span<const std::byte> bytes) {
    sha256_update(&context_, bytes.size(), reinterpret_cast<const uint8_t*>(bytes.data()));
  }
  Sha256Digest Finish() {  // and starts a new message
    Sha256Digest digest;
    sha256_digest(&context_, digest.bytes.size(), digest.bytes.data());
    return digest;
  }

 private:
  sha256_ctx context_;
};

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

Sha256::Sha256() : state_(std::make_unique<State>()) {}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::Add(std::span<const std::byte> bytes) { state_->Add(bytes); }

Sha256Digest Sha256::Finish() { return state_->Finish(); }

Sha256Digest Sha256Of(std::span<const std::byte> bytes) {
  Sha256 sha;
  sha.Add(bytes);
  return sha.Finish();
}

Sha256Digest Sha256Of(std::string_view bytes) { return Sha256Of(std::as_bytes(std::span(bytes))); }

}  // namespace bccskel
