#ifndef BCCSKEL_SERVER_IDENTITY_TOKEN_H_
#define BCCSKEL_SERVER_IDENTITY_TOKEN_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/digest/sha256.h"

namespace bccskel::server {

// 256 bits of the system's randomness as text: "bccskel_" and 64 hexadecimal digits.
// Errors: UNAVAILABLE when the system gives none.
absl::StatusOr<std::string> NewToken();

// What is kept of a token. No salt and no slow hash: unlike a password, a token cannot be guessed.
Sha256Digest DigestOfToken(std::string_view token);

// Takes the same time wherever the two differ.
bool SameDigest(const Sha256Digest& a, const Sha256Digest& b);

// 1 to 64 characters of a-z, 0-9, '-' and '_', a letter or digit first: fit for a metric's label.
bool IsTenantName(std::string_view name);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_IDENTITY_TOKEN_H_
