#include "server/durable/run_queue.h"

#include <chrono>
#include <limits>
#include <utility>

namespace bccskel::server {
namespace {

using std::chrono::minutes, std::chrono::seconds;

// As in jobs/fair_queue.h.
constexpr seconds kWorthOfPriority(30);
constexpr minutes kCostOfCrash(10);

}  // namespace

RunQueue::Place RunQueue::PlaceOf(const JobRow& job) {
  const bool suspect = job.crashes > 0;
  const Time came = suspect ? job.started.value_or(job.created) : job.created;
  return {came - job.priority * kWorthOfPriority + job.crashes * kCostOfCrash, job.number, suspect};
}

std::optional<int64_t> RunQueue::FirstOf(const Tenant& tenant, Suspects suspects) {
  for (const auto& [rank, number, suspect] : tenant.places) {
    if (!suspect || suspects == Suspects::kWelcome) return number;
  }
  return std::nullopt;
}

void RunQueue::Add(const JobRow& job) {
  if (tenants_[job.tenant].places.insert(PlaceOf(job)).second) ++size_;
}

void RunQueue::Remove(const JobRow& job) {
  const auto tenant = tenants_.find(job.tenant);
  if (tenant == tenants_.end() || tenant->second.places.erase(PlaceOf(job)) == 0) return;
  --size_;
  if (tenant->second.places.empty()) tenants_.erase(tenant);
}

std::optional<int64_t> RunQueue::First(const std::map<std::string, int>& at_work_of,
                                       Suspects suspects, const TenantTable& tenants) const {
  std::pair<double, uint64_t> best = {std::numeric_limits<double>::max(), 0};
  std::optional<int64_t> first;
  for (const auto& [name, tenant] : tenants_) {
    const auto found = at_work_of.find(name);
    const int at_work = found == at_work_of.end() ? 0 : found->second;
    const TenantLimits& limits = tenants.Of(name);
    if (limits.max_running > 0 && at_work >= limits.max_running) continue;
    const std::pair<double, uint64_t> share = {double{1} * at_work / limits.weight,
                                               tenant.last_turn};
    if (first.has_value() && best <= share) continue;
    const std::optional<int64_t> job = FirstOf(tenant, suspects);
    if (!job.has_value()) continue;
    best = share;
    first = job;
  }
  return first;
}

void RunQueue::CountTurn(const std::string& tenant) {
  const auto found = tenants_.find(tenant);
  if (found != tenants_.end()) found->second.last_turn = ++turns_;
}

}  // namespace bccskel::server
