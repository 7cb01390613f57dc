#ifndef BCCSKEL_SERVER_STORE_DISK_QUOTA_H_
#define BCCSKEL_SERVER_STORE_DISK_QUOTA_H_

#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// Counts the actual or declared bytes of files, in total and per tenant. 0 means no limit.
// Threads: safe.
class DiskQuota {
 public:
  DiskQuota(uint64_t most, uint64_t most_of_tenant)
      : most_(most), most_of_tenant_(most_of_tenant) {}

  // Errors: DISK_FULL with the usage and the limit; nothing is then taken.
  absl::Status Take(const std::string& tenant, uint64_t bytes);
  // Counts existing bytes regardless of the limits.
  void Count(const std::string& tenant, uint64_t bytes);
  void GiveBack(const std::string& tenant, uint64_t bytes);
  // Replaces the counts, in a fleet with those of all servers.
  void Replace(std::map<std::string, uint64_t> used);
  uint64_t used() const;
  uint64_t available() const;  // for all tenants; the largest number without a limit

 private:
  void Add(const std::string& tenant, uint64_t bytes);  // Needs: mutex_ held.

  const uint64_t most_;
  const uint64_t most_of_tenant_;
  mutable std::mutex mutex_;
  uint64_t used_ = 0;                        // guarded by mutex_
  std::map<std::string, uint64_t> used_of_;  // guarded by mutex_
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_DISK_QUOTA_H_
