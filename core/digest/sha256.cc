#include "core/digest/sha256.h"

// The calls that OpenSSL 3 calls old do not first load its configuration and its algorithms, which
// takes as long as the skeleton of a small object.
#define OPENSSL_SUPPRESS_DEPRECATED
#include <openssl/sha.h>

namespace bccskel {

class Sha256::State {
 public:
  State() { SHA256_Init(&context_); }
  void Add(std::span<const std::byte> bytes) {
    SHA256_Update(&context_, bytes.data(), bytes.size());
  }
  Sha256Digest Finish() {
    Sha256Digest digest;
    SHA256_Final(digest.bytes.data(), &context_);
    SHA256_Init(&context_);
    return digest;
  }

 private:
  SHA256_CTX context_;
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
