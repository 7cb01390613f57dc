#ifndef BCCSKEL_SERVER_IDENTITY_TOKEN_TABLE_H_
#define BCCSKEL_SERVER_IDENTITY_TOKEN_TABLE_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "core/digest/sha256.h"
#include "server/admission/tenant_limits.h"

namespace bccskel::server {

// 256 bits of the system's randomness as text: "bccskel_" and 64 hexadecimal digits.
// Errors: UNAVAILABLE when the system gives none.
absl::StatusOr<std::string> NewToken();

// Takes the same time wherever the two differ.
bool SameDigest(const Sha256Digest& a, const Sha256Digest& b);

// 1 to 64 characters of a-z, 0-9, '-' and '_', a letter or digit first: fit for a metric's label.
bool IsTenantName(std::string_view name);

enum class Role { kTenant, kAdmin };

// Whose call it is, and whether it may ask for what concerns all tenants.
struct Caller {
  std::string tenant;
  Role role = Role::kTenant;
};

// The tokens that are accepted and the tenants they stand for. As text, a token a line:
//
//   acme  9f86d081884c7d65...  weight=2 max-jobs=40 max-running=4 max-memory-bytes=8GB
//   acme  60303ae22b998861...            # a second token of the same tenant
//   ops   fd61a03af4f77d87...  admin     # may call the AdminService, too
//
// The second word is the SHA-256 of the token: no salt and no slow hash, for unlike a password, a
// token cannot be guessed. A '#' begins a comment.
class TokenTable {
 public:
  // Errors: INVALID_ARGUMENT with the line; the message holds no digest.
  static absl::StatusOr<TokenTable> Parse(std::string_view text);
  // Errors: NOT_FOUND where the file cannot be read; INVALID_ARGUMENT.
  static absl::StatusOr<TokenTable> ReadFile(const std::string& path);

  // Nothing for a token that is not accepted. Takes the same time for any.
  std::optional<Caller> Find(std::string_view token) const;

  const std::map<std::string, TenantLimits>& tenants() const { return tenants_; }

 private:
  struct Entry {
    Sha256Digest digest;
    Caller caller;
  };

  absl::Status AddLine(const std::vector<std::string>& words);
  absl::Status AddTerm(const std::string& word, Entry& entry);

  std::vector<Entry> entries_;
  std::map<std::string, TenantLimits> tenants_;
};

// The line of a token, without its end.
std::string TokenLine(const std::string& tenant, std::string_view token);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_IDENTITY_TOKEN_TABLE_H_
