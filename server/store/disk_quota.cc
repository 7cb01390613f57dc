#include "server/store/disk_quota.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

bool Exceeds(uint64_t used, uint64_t bytes, uint64_t limit) {
  return limit > 0 && (used > limit || bytes > limit - used);
}

}  // namespace

absl::Status DiskQuota::Take(const std::string& tenant, uint64_t bytes) {
  std::lock_guard lock(mutex_);
  const auto found = used_of_.find(tenant);
  const uint64_t own = found == used_of_.end() ? 0 : found->second;
  if (Exceeds(own, bytes, most_of_tenant_)) {
    return DiskFull(absl::StrCat(bytes, " more bytes on disk: ", own, " are in use, the limit is ",
                                 most_of_tenant_),
                    "max_tenant_disk_bytes");
  }
  if (Exceeds(used_, bytes, most_)) {
    // Does not state the usage, which includes that of other tenants.
    return DiskFull(absl::StrCat(bytes, " more bytes on disk are over the server's ", "limit of ",
                                 most_, " for all"),
                    "max_disk_bytes");
  }
  Add(tenant, bytes);
  return absl::OkStatus();
}

void DiskQuota::Count(const std::string& tenant, uint64_t bytes) {
  std::lock_guard lock(mutex_);
  Add(tenant, bytes);
}

void DiskQuota::Add(const std::string& tenant, uint64_t bytes) {
  used_ += bytes;
  used_of_[tenant] += bytes;
}

void DiskQuota::GiveBack(const std::string& tenant, uint64_t bytes) {
  std::lock_guard lock(mutex_);
  used_ -= std::min(bytes, used_);
  const auto found = used_of_.find(tenant);
  if (found == used_of_.end()) return;
  found->second -= std::min(bytes, found->second);
  if (found->second == 0) used_of_.erase(found);
}

void DiskQuota::Replace(std::map<std::string, uint64_t> used) {
  std::lock_guard lock(mutex_);
  used_of_ = std::move(used);
  used_ = 0;
  for (const auto& [tenant, bytes] : used_of_) used_ += bytes;
}

uint64_t DiskQuota::used() const {
  std::lock_guard lock(mutex_);
  return used_;
}

uint64_t DiskQuota::available() const {
  std::lock_guard lock(mutex_);
  if (most_ == 0) return std::numeric_limits<uint64_t>::max();
  return most_ - std::min(used_, most_);
}

}  // namespace bccskel::server
