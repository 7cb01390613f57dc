#include "core/digest/sha256.h"

#include <openssl/evp.h>

#include <cstdlib>

namespace bccskel {
namespace {

// OpenSSL fails here only when it has no memory or no SHA-256 at all; a digest that is not one must
// never be handed out, and the process cannot do its work without it.
void Require(bool done) {
  if (!done) std::abort();
}

struct FreeContext {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

}  // namespace

class Sha256::State {
 public:
  State() : context_(EVP_MD_CTX_new()) {
    Require(context_ != nullptr);
    Start();
  }
  void Start() { Require(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1); }
  void Add(std::span<const std::byte> bytes) {
    Require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
  }
  Sha256Digest Finish() {
    Sha256Digest digest;
    unsigned int length = 0;
    Require(EVP_DigestFinal_ex(context_.get(), digest.bytes.data(), &length) == 1);
    Require(length == digest.bytes.size());
    return digest;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, FreeContext> context_;
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

Sha256Digest Sha256::Finish() {
  const Sha256Digest digest = state_->Finish();
  state_->Start();
  return digest;
}

Sha256Digest Sha256Of(std::span<const std::byte> bytes) {
  Sha256 sha;
  sha.Add(bytes);
  return sha.Finish();
}

Sha256Digest Sha256Of(std::string_view bytes) { return Sha256Of(std::as_bytes(std::span(bytes))); }

}  // namespace bccskel
