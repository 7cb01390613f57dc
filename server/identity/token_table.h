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

// 256 random bits from the system as text: "bccskel_" and 64 hexadecimal digits.
// Errors: UNAVAILABLE when the system provides none.
absl::StatusOr<std::string> NewToken();

// Compares in constant time.
bool SameDigest(const Sha256Digest& a, const Sha256Digest& b);

// 1 to 64 characters of a-z, 0-9, '-' and '_', beginning with a letter or digit: safe as a metric's
// label.
bool IsTenantName(std::string_view name);

enum class Role { kTenant, kAdmin };

// The caller's tenant, and whether it may make admin calls.
struct Caller {
  std::string tenant;
  Role role = Role::kTenant;
};

// The accepted tokens and their tenants. As text, one token per line:
//
//   acme  9f86d081884c7d65...  weight=2 max-jobs=40 max-running=4 max-memory-bytes=8GB
//   acme  60303ae22b998861...            # a second token of the same tenant
//   ops   fd61a03af4f77d87...  admin     # may call the AdminService, too
//
// The second word is the SHA-256 of the token. It needs no salt and no slow hash because, unlike a
// password, a token cannot be guessed. A '#' begins a comment.
class TokenTable {
 public:
  // Errors: INVALID_ARGUMENT with the first twenty errors and their lines; the message holds no
  //         digest.
  static absl::StatusOr<TokenTable> Parse(std::string_view text);
  // Errors: NOT_FOUND if the file cannot be read; INVALID_ARGUMENT.
  static absl::StatusOr<TokenTable> ReadFile(const std::string& path);

  // nullopt for an unknown token. Takes the same time for any token.
  std::optional<Caller> Find(std::string_view token) const;

  const std::map<std::string, TenantLimits>& tenants() const { return tenants_; }

 private:
  struct Entry {
    Sha256Digest digest;
    Caller caller;
  };

  // Add one entry; yield all that is wrong with it.
  std::vector<std::string> AddLine(const std::vector<std::string>& words);
  absl::Status AddTerm(const std::string& word, Entry& entry);

  std::vector<Entry> entries_;
  std::map<std::string, TenantLimits> tenants_;
};

// The line of a token, without the line break.
std::string TokenLine(const std::string& tenant, std::string_view token);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_IDENTITY_TOKEN_TABLE_H_
