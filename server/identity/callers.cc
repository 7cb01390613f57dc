#include "server/identity/callers.h"

#include <utility>

#include "absl/strings/ascii.h"
#include "core/exec/status_macros.h"

namespace bccskel::server {
namespace {

// The token of a header such as "Bearer TOKEN"; the scheme is case-insensitive (RFC 9110).
std::optional<std::string_view> BearerToken(std::string_view header) {
  constexpr std::string_view kScheme = "bearer ";
  if (header.size() <= kScheme.size()) return std::nullopt;
  for (size_t n = 0; n < kScheme.size(); ++n) {
    if (absl::ascii_tolower(static_cast<unsigned char>(header[n])) != kScheme[n]) {
      return std::nullopt;
    }
  }
  return header.substr(kScheme.size());
}

}  // namespace

absl::StatusOr<std::unique_ptr<Callers>> Callers::Create(const std::string& path) {
  std::unique_ptr<Callers> callers(new Callers(path));
  BCCSKEL_RETURN_IF_ERROR(callers->ReloadNow().status());
  return callers;
}

absl::StatusOr<Caller> Callers::Identify(std::optional<std::string_view> authorization) const {
  if (path_.empty()) return Caller{.tenant = kDefaultTenant, .role = Role::kAdmin};
  if (!authorization.has_value()) {
    return absl::UnauthenticatedError(
        "this server requires a token (metadata \"authorization: Bearer TOKEN\")");
  }
  const std::optional<std::string_view> token = BearerToken(*authorization);
  const std::optional<Caller> caller =
      token.has_value() ? table()->Find(*token) : std::optional<Caller>();
  if (!caller.has_value()) return absl::UnauthenticatedError("the token is not accepted");
  return *caller;
}

std::shared_ptr<const TokenTable> Callers::table() const {
  std::lock_guard lock(mutex_);
  return table_;
}

std::map<std::string, TenantLimits> Callers::tenants() const {
  if (path_.empty()) return {};
  return table()->tenants();
}

absl::StatusOr<Reload> Callers::ReloadIfChanged() {
  {
    std::lock_guard lock(reload_mutex_);
    if (path_.empty() || !changes_.Look()) return Reload::kNotNeeded;
  }
  return ReloadNow();
}

absl::StatusOr<Reload> Callers::ReloadNow() {
  if (path_.empty()) return Reload::kNotNeeded;
  std::lock_guard reload_lock(reload_mutex_);
  changes_.Look();
  BCCSKEL_ASSIGN_OR_RETURN(TokenTable table, TokenTable::ReadFile(path_));
  std::lock_guard lock(mutex_);
  table_ = std::make_shared<const TokenTable>(std::move(table));
  ++generation_;
  return Reload::kDone;
}

}  // namespace bccskel::server
