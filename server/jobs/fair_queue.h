#ifndef BCCSKEL_SERVER_JOBS_FAIR_QUEUE_H_
#define BCCSKEL_SERVER_JOBS_FAIR_QUEUE_H_

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "server/admission/tenant_limits.h"

namespace bccskel::server {

// The priority among the jobs of one tenant.
enum class JobPriority { kLow = -1, kNormal = 0, kHigh = 1 };

// A job's tenant and priority. They affect turns and caps, never results.
struct JobOrigin {
  std::string tenant;  // "": the tenant of all callers without a name
  JobPriority priority = JobPriority::kNormal;
};

// Decides which item is next, among jobs in memory and durable ones alike.
// - Tenants take turns, as many per round as their weight. One that returns after a pause has
//   neither credit nor debt.
// - A tenant that has reached its cap of running items is skipped.
// - Within a tenant the oldest item is first, where a level of priority equals half a minute of
//   waiting: an item of low priority precedes one of high priority that arrived more than a minute
//   later.
// Threads: one at a time; callers pass the time.
template <typename Item, typename Clock = std::chrono::steady_clock>
class FairQueue {
 public:
  using TimePoint = typename Clock::time_point;
  static constexpr std::chrono::seconds kWaitPerPriority{30};

  // The place of a waiting item.
  struct Entry {
    std::string tenant;
    std::pair<TimePoint, uint64_t> rank;
  };
  struct Taken {
    std::string tenant;
    Item item;
  };

  // `max_at_work`: a cap for each tenant in addition to its limits; 0: no cap.
  explicit FairQueue(TenantTable limits = {}, int max_at_work = 0)
      : limits_(std::move(limits)), max_at_work_(max_at_work) {}

  // From now on.
  void SetLimits(TenantTable limits) { limits_ = std::move(limits); }
  // Tenants' running items that were not taken from this queue.
  void SetAtWorkElsewhere(std::map<std::string, int> at_work) { elsewhere_ = std::move(at_work); }

  // Tenants whose items must not be taken now.
  void PassOver(std::set<std::string> tenants) { passed_over_ = std::move(tenants); }

  // `came`: when the item began to wait.
  Entry Push(const JobOrigin& origin, TimePoint came, Item item) {
    Tenant& tenant = tenants_[origin.tenant];
    if (tenant.waiting.empty()) tenant.next_turn = std::max(tenant.next_turn, time_);
    const auto priority = static_cast<int>(origin.priority);
    const Rank rank = {came - priority * kWaitPerPriority, next_number_++};
    tenant.waiting.emplace(rank, std::move(item));
    ++size_;
    return {origin.tenant, rank};
  }

  // False if it is not waiting.
  bool Remove(const Entry& entry) {
    const auto tenant = tenants_.find(entry.tenant);
    if (tenant == tenants_.end() || tenant->second.waiting.erase(entry.rank) == 0) return false;
    --size_;
    Forget(entry.tenant);
    return true;
  }

  bool empty() const { return size_ == 0; }
  size_t size() const { return size_; }

  // Visits all waiting items, whatever the caps.
  template <typename Visit>
  void ForEach(Visit visit) const {
    for (const auto& [name, tenant] : tenants_) {
      for (const auto& [rank, item] : tenant.waiting) visit(item);
    }
  }

  // Whether Take() would yield an item.
  template <typename Fits>
  bool Has(Fits fits) const {
    return std::ranges::any_of(tenants_, [&](const auto& entry) {
      return MayStart(entry.first, entry.second) && FirstOf(entry.second, fits).has_value();
    });
  }
  bool Has() const { return Has(&Anything); }

  // The next item that fits. It counts as running until Done().
  template <typename Fits>
  std::optional<Taken> Take(Fits fits) {
    Place best = {tenants_.end(), {}};
    for (auto at = tenants_.begin(); at != tenants_.end(); ++at) {
      if (!MayStart(at->first, at->second)) continue;
      if (best.first != tenants_.end() && best.first->second.next_turn <= at->second.next_turn) {
        continue;
      }
      if (const auto rank = FirstOf(at->second, fits)) best = {at, *rank};
    }
    if (best.first == tenants_.end()) return std::nullopt;
    return Start(best);
  }
  std::optional<Taken> Take() { return Take(&Anything); }

  void Done(const std::string& tenant) {
    --tenants_[tenant].at_work;
    Forget(tenant);
  }

 private:
  using Rank = std::pair<TimePoint, uint64_t>;
  struct Tenant {
    std::map<Rank, Item> waiting;
    uint64_t next_turn = 0;  // in time_'s units
    int at_work = 0;
  };
  using Place = std::pair<typename std::map<std::string, Tenant>::iterator, Rank>;
  static constexpr uint64_t kRound = uint64_t{1} << 20;

  static bool Anything(const Item&) { return true; }

  bool MayStart(const std::string& name, const Tenant& tenant) const {
    if (passed_over_.contains(name)) return false;
    const int most = limits_.Of(name).max_running;
    const auto elsewhere = elsewhere_.find(name);
    const int at_work = tenant.at_work + (elsewhere == elsewhere_.end() ? 0 : elsewhere->second);
    return (most == 0 || at_work < most) && (max_at_work_ == 0 || tenant.at_work < max_at_work_);
  }

  template <typename Fits>
  static std::optional<Rank> FirstOf(const Tenant& tenant, Fits fits) {
    const auto found = std::ranges::find_if(
        tenant.waiting, [&fits](const auto& item) { return fits(item.second); });
    if (found == tenant.waiting.end()) return std::nullopt;
    return found->first;
  }

  Taken Start(const Place& place) {
    auto& [name, tenant] = *place.first;
    const auto weight = static_cast<uint64_t>(std::max(1, limits_.Of(name).weight));
    time_ = std::max(time_, tenant.next_turn);
    tenant.next_turn += kRound / weight;
    ++tenant.at_work;
    --size_;
    return {name, std::move(tenant.waiting.extract(place.second).mapped())};
  }

  void Forget(const std::string& name) {
    const auto found = tenants_.find(name);
    if (found->second.waiting.empty() && found->second.at_work == 0) tenants_.erase(found);
  }

  TenantTable limits_;
  const int max_at_work_;
  std::map<std::string, Tenant> tenants_;  // tenants with waiting or running items
  uint64_t time_ = 0;                      // virtual: a round is equally long for every tenant
  std::map<std::string, int> elsewhere_;
  std::set<std::string> passed_over_;
  uint64_t next_number_ = 1;
  size_t size_ = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_FAIR_QUEUE_H_
