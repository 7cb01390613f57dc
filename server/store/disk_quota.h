#ifndef BCCSKEL_SERVER_STORE_DISK_QUOTA_H_
#define BCCSKEL_SERVER_STORE_DISK_QUOTA_H_

#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// Counts the bytes that files have or will have, over all and per tenant. 0 means no limit.
// Threads: safe.
class DiskQuota {
 public:
  DiskQuota(uint64_t most, uint64_t most_of_tenant)
      : most_(most), most_of_tenant_(most_of_tenant) {}

  // Errors: DISK_FULL with what is used and the limit; then nothing is taken.
  absl::Status Take(const std::string& tenant, uint64_t bytes);
  // What is there already counts, whatever the limits are now.
  void Count(const std::string& tenant, uint64_t bytes);
  void GiveBack(const std::string& tenant, uint64_t bytes);
  // What others have counted, instead of what was counted here.
  void Replace(std::map<std::string, uint64_t> used);
  uint64_t used() const;
  uint64_t available() const;  // for all; the largest number where there is no limit

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
