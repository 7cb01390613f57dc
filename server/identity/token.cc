#include "server/identity/token.h"

#include <sys/random.h>

#include <algorithm>
#include <cctype>

namespace bccskel::server {

absl::StatusOr<std::string> NewToken() {
  Sha256Digest secret;  // for its size and its digits
  const ssize_t got = getrandom(secret.bytes.data(), secret.bytes.size(), 0);
  if (got != static_cast<ssize_t>(secret.bytes.size())) {
    return absl::UnavailableError("the system gives no random bytes");
  }
  return "bccskel_" + secret.Hex();
}

Sha256Digest DigestOfToken(std::string_view token) { return Sha256Of(token); }

bool SameDigest(const Sha256Digest& a, const Sha256Digest& b) {
  unsigned difference = 0;
  for (size_t n = 0; n < a.bytes.size(); ++n) {
    difference |= static_cast<unsigned>(a.bytes[n] ^ b.bytes[n]);
  }
  return difference == 0;
}

bool IsTenantName(std::string_view name) {
  constexpr size_t kLongest = 64;
  const auto plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  return !name.empty() && name.size() <= kLongest && plain(name.front()) &&
         std::ranges::all_of(name, [&](char c) { return plain(c) || c == '-' || c == '_'; });
}

}  // namespace bccskel::server
