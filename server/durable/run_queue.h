#ifndef BCCSKEL_SERVER_DURABLE_RUN_QUEUE_H_
#define BCCSKEL_SERVER_DURABLE_RUN_QUEUE_H_

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "server/admission/tenant_limits.h"
#include "server/store/rows.h"

namespace bccskel::server {

// Jobs that wait to be run. The turn is the tenant's with the fewest jobs at work for its weight;
// among those the one's that had no turn for the longest time. Who has as many at work as it may
// have is passed over. Within a tenant older jobs come first, where a level
// of priority is worth half a minute of waiting. A job that ran while the server crashed may be the
// reason: it is a suspect, and stands back as if it had come ten minutes after it began to run.
// Threads: one at a time.
class RunQueue {
 public:
  void Add(const JobRow& job);
  void Remove(const JobRow& job);
  enum class Suspects { kWelcome, kWait };
  // The number of the job whose turn it is. It stays in the queue.
  std::optional<int64_t> First(const std::map<std::string, int>& at_work_of,
                               Suspects suspects = Suspects::kWelcome,
                               const TenantTable& tenants = {}) const;
  // The tenant has had a turn.
  void CountTurn(const std::string& tenant);

  void Clear() { *this = RunQueue(); }
  int size() const { return size_; }

 private:
  using Place = std::tuple<Time, int64_t, bool>;  // less is earlier
  struct Tenant {
    std::set<Place> places;
    uint64_t last_turn = 0;
  };
  static Place PlaceOf(const JobRow& job);
  static std::optional<int64_t> FirstOf(const Tenant& tenant, Suspects suspects);

  std::map<std::string, Tenant> tenants_;  // those with a job
  uint64_t turns_ = 0;
  int size_ = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_RUN_QUEUE_H_
