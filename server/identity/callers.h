#ifndef BCCSKEL_SERVER_IDENTITY_CALLERS_H_
#define BCCSKEL_SERVER_IDENTITY_CALLERS_H_

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/identity/file_changes.h"
#include "server/identity/token_table.h"

namespace bccskel::server {

// The tenant of all calls on a server without tokens.
inline constexpr char kDefaultTenant[] = "default";

// Identifies callers by a file of tokens that may change while the server runs.
// Threads: safe.
class Callers {
 public:
  // Without a path every caller is the default tenant and an admin.
  // Errors: as TokenTable::ReadFile().
  static absl::StatusOr<std::unique_ptr<Callers>> Create(const std::string& path);

  // `authorization` is the header of that name, if the call has one.
  // Errors: UNAUTHENTICATED; the message holds nothing of the header.
  absl::StatusOr<Caller> Identify(std::optional<std::string_view> authorization) const;

  // What the tenants are granted; empty without tokens.
  std::map<std::string, TenantLimits> tenants() const;

  // Increases each time a file is loaded.
  uint64_t generation() const { return generation_; }

  // Reads the file again if it has changed since the last read. A file with an error changes
  // nothing: the old tokens stay valid.
  // Errors: as TokenTable::ReadFile(), once for each change of the file.
  absl::StatusOr<Reload> ReloadIfChanged();
  absl::StatusOr<Reload> ReloadNow();

 private:
  explicit Callers(const std::string& path) : path_(path), changes_({path}) {}
  std::shared_ptr<const TokenTable> table() const;

  const std::string path_;  // empty: no tokens
  mutable std::mutex mutex_;
  std::shared_ptr<const TokenTable> table_;  // guarded by mutex_
  std::atomic<uint64_t> generation_ = 0;
  std::mutex reload_mutex_;
  FileChanges changes_;  // guarded by reload_mutex_
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_IDENTITY_CALLERS_H_
