#ifndef BCCSKEL_SERVER_ADMISSION_TENANT_LIMITS_H_
#define BCCSKEL_SERVER_ADMISSION_TENANT_LIMITS_H_

#include <algorithm>
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

  // Whether a tenant has a share of the places instead of a limit of its own.
  bool Shares(const std::string& tenant) const {
    return Of(tenant).max_jobs == 0 && named.size() > 1;
  }
  // The most of `places` that a tenant may take: its limit, or half of what others leave, or all.
  int MostPlaces(const std::string& tenant, int places, int taken_by_others) const {
    const int own = Of(tenant).max_jobs;
    if (own > 0) return std::min(own, places);
    return Shares(tenant) ? (places - taken_by_others + 1) / 2 : places;
  }
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_ADMISSION_TENANT_LIMITS_H_
