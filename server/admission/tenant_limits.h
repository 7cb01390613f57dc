#ifndef BCCSKEL_SERVER_ADMISSION_TENANT_LIMITS_H_
#define BCCSKEL_SERVER_ADMISSION_TENANT_LIMITS_H_

#include <cstdint>
#include <map>
#include <string>

namespace bccskel::server {

// Limits of one tenant. 0 means no limit beyond that of all tenants together.
struct TenantLimits {
  int weight = 1;          // turns at computing and decoding per round; at least 1
  int max_jobs = 0;        // receiving, waiting or running
  int max_running = 0;     // at the same time
  uint64_t max_bytes = 0;  // working memory
};

struct TenantTable {
  TenantLimits each;                          // for each tenant that is not named
  std::map<std::string, TenantLimits> named;  // by tenant

  const TenantLimits& Of(const std::string& tenant) const {
    const auto found = named.find(tenant);
    return found == named.end() ? each : found->second;
  }
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_ADMISSION_TENANT_LIMITS_H_
