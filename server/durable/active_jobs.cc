#include "server/durable/active_jobs.h"

#include <algorithm>
#include <utility>

namespace bccskel::server {
namespace {

// Limit of computed results that are not stored yet: they hold memory.
constexpr int kMostUnstored = 16;
// When all places have been held for this long, a tenant that has none need not wait for one. While
// places change hands sooner, tenants take turns by weight.
constexpr std::chrono::seconds kLongHeld(1);
// Limit of jobs at the runner then, in places.
constexpr int kMostByTurn = 2;

}  // namespace

ActiveJob* ActiveJobs::Find(int64_t job) {
  const auto found = jobs_.find(job);
  return found == jobs_.end() ? nullptr : &found->second;
}

int ActiveJobs::CountOf(const std::string& tenant) const {
  const auto found = of_tenant_.find(tenant);
  return found == of_tenant_.end() ? 0 : found->second;
}

ActiveJob& ActiveJobs::Put(const JobRow& row) {
  ActiveJob* job = Find(row.number);
  if (job != nullptr) --in_state_[static_cast<size_t>(job->row.state)];
  if (job == nullptr) {
    job = &jobs_[row.number];
    ++of_tenant_[row.tenant];
  }
  Dequeue(*job);
  job->row = row;
  ++in_state_[static_cast<size_t>(row.state)];
  return *job;
}

void ActiveJobs::Forget(int64_t job) {
  const auto found = jobs_.find(job);
  if (found == jobs_.end()) return;
  --in_state_[static_cast<size_t>(found->second.row.state)];
  const auto count = of_tenant_.find(found->second.row.tenant);
  if (--count->second == 0) of_tenant_.erase(count);
  Dequeue(found->second);
  Detach(job);
  jobs_.erase(found);
}

ActiveRun& ActiveJobs::AddRun(std::shared_ptr<Run> run, const JobRow& job,
                              ActiveRun::Source source) {
  ActiveRun& active = runs_[run.get()];
  active.run = std::move(run);
  active.source = source;
  active.tenant = job.tenant;
  active.options = job.options;
  return active;
}

ActiveRun* ActiveJobs::FindRun(const Run* run) {
  const auto found = runs_.find(run);
  return found == runs_.end() ? nullptr : &found->second;
}

ActiveRun* ActiveJobs::FindOpen(const Run* run) {
  ActiveRun* const found = FindRun(run);
  return found == nullptr || found->ending ? nullptr : found;
}

template <typename Volume>
ActiveRun* ActiveJobs::FindJoinable(const std::string& tenant, const std::string& options,
                                    Volume is_equal) {
  const auto found = std::ranges::find_if(runs_, [&](const auto& entry) {
    const ActiveRun& run = entry.second;
    return !run.ending && run.tenant == tenant && run.options == options && is_equal(run);
  });
  return found == runs_.end() ? nullptr : &found->second;
}

ActiveRun* ActiveJobs::FindEqual(const JobRow& job, const VolumeRow& volume) {
  return FindJoinable(job.tenant, job.options, [&](const ActiveRun& run) {
    return !run.volume.empty() &&
           (run.volume == volume.name ||
            (!run.volume_digest.empty() && run.volume_digest == volume.volume_digest));
  });
}

ActiveRun* ActiveJobs::FindEqual(const ActiveRun& run) {
  return FindJoinable(run.tenant, run.options, [&run](const ActiveRun& other) {
    return &other != &run && other.volume_digest == run.volume_digest;
  });
}

void ActiveJobs::Attach(ActiveRun& run, int64_t job) {
  run.jobs.insert(job);
  jobs_.at(job).run = run.run.get();
}

void ActiveJobs::Detach(int64_t job) {
  ActiveJob* const found = Find(job);
  if (found == nullptr || found->run == nullptr) return;
  ActiveRun* const run = FindRun(std::exchange(found->run, nullptr));
  if (run == nullptr) return;
  run->jobs.erase(job);
  if (run->jobs.empty() && !run->ending) run->run->Cancel();
}

void ActiveJobs::ForgetRun(const Run* run) {
  const auto found = runs_.find(run);
  if (found == runs_.end()) return;
  for (const int64_t number : found->second.jobs) {
    ActiveJob* const job = Find(number);
    if (job != nullptr && job->run == run) job->run = nullptr;
  }
  runs_.erase(found);
}

void ActiveJobs::CancelRuns() {
  for (const auto& [pointer, run] : runs_) run.run->Cancel();
}

void ActiveJobs::ForgetRuns() {
  CancelRuns();
  runs_.clear();
  for (auto& [number, job] : jobs_) {
    job.run = nullptr;
    if (job.row.state == JobState::kQueued) Enqueue(job);
  }
}

void ActiveJobs::Computed(ActiveRun& run) {
  run.computed = true;
  if (run.source == ActiveRun::Source::kFile) pace_.Computed(run.fed, RunPace::Clock::now());
}

// A suspect queues as if it had arrived ten minutes after its last start.
void ActiveJobs::Enqueue(ActiveJob& job) {
  constexpr std::chrono::minutes kCostOfCrash(10);
  if (job.place.has_value()) return;
  const JobRow& row = job.row;
  const bool suspect = row.crashes > 0;
  const Time came = suspect ? row.started.value_or(row.created) : row.created;
  job.place =
      queue_.Push({.tenant = row.tenant, .priority = PriorityOf(row)},
                  came + row.crashes * kCostOfCrash, {.job = row.number, .suspect = suspect});
}

void ActiveJobs::Dequeue(ActiveJob& job) {
  if (job.place.has_value()) queue_.Remove(*std::exchange(job.place, std::nullopt));
}

void ActiveJobs::WaitForEqual(ActiveJob& job) {
  Dequeue(job);
  waiting_for_equal_.insert(job.row.number);
}

void ActiveJobs::QueueWaiting() {
  for (const int64_t number : std::exchange(waiting_for_equal_, {})) {
    ActiveJob* const job = Find(number);
    const bool waits = job != nullptr && job->row.state == JobState::kQueued;
    if (waits && job->run == nullptr) Enqueue(*job);
  }
}

std::map<std::string, int> ActiveJobs::RunsOfTenants() const {
  std::map<std::string, int> runs;
  for (const auto& [pointer, run] : runs_) {
    if (!run.volume.empty()) ++runs[run.tenant];  // uploads in progress do not count
  }
  if (!shared_) return runs;
  for (const auto& [number, job] : jobs_) {
    const bool elsewhere = job.row.state == JobState::kRunning && job.run == nullptr;
    if (elsewhere) ++runs[job.row.tenant];
  }
  return runs;
}

template <typename Which>
int ActiveJobs::CountRunsFromFiles(Which which) const {
  return static_cast<int>(std::ranges::count_if(runs_, [&which](const auto& entry) {
    return entry.second.source == ActiveRun::Source::kFile && which(entry.second);
  }));
}

ActiveJobs::Room ActiveJobs::RoomFor(int max_runs) const {
  const int unstored = CountRunsFromFiles([](const ActiveRun& run) { return run.computed; });
  const int at_runner = CountRunsFromFiles([](const ActiveRun& run) { return !run.computed; });
  if (unstored > kMostUnstored) return Room::kNone;
  if (at_runner < max_runs) return Room::kPlace;
  if (next_.has_value()) return Room::kNone;
  if (at_runner < max_runs + pace_.Ahead()) return Room::kAhead;
  const RunPace::Clock::time_point now = RunPace::Clock::now();
  const int long_held = CountRunsFromFiles([now](const ActiveRun& run) {
    const bool fed = run.fed != RunPace::Clock::time_point();
    return !run.computed && fed && now - run.fed >= kLongHeld;
  });
  const bool turn = long_held >= max_runs && at_runner < kMostByTurn * max_runs;
  return turn ? Room::kTurn : Room::kNone;
}

// Suspects run one at a time: a crash then incriminates only one of them, and innocent ones are
// soon cleared.
auto ActiveJobs::MayBegin(const TenantTable& tenants, Room room) {
  queue_.SetLimits(tenants);
  queue_.SetAtWorkElsewhere(RunsOfTenants());
  std::set<std::string> passed_over;
  if (room == Room::kTurn) {
    for (const auto& [pointer, run] : runs_) {
      if (run.source == ActiveRun::Source::kFile && !run.computed) passed_over.insert(run.tenant);
    }
  }
  queue_.PassOver(std::move(passed_over));
  const int suspects = CountRunsFromFiles([](const ActiveRun& run) { return run.crashes > 0; });
  return [suspects](const WaitingJob& job) { return !job.suspect || suspects == 0; };
}

bool ActiveJobs::HasNext(const TenantTable& tenants, int max_runs) {
  const Room room = RoomFor(max_runs);
  if (room == Room::kNone) return false;
  return next_.has_value() || queue_.Has(MayBegin(tenants, room));
}

std::optional<ActiveJobs::Turn> ActiveJobs::TakeNext(const TenantTable& tenants, int max_runs) {
  const Room room = RoomFor(max_runs);
  if (room == Room::kNone) return std::nullopt;
  if (next_.has_value()) {
    const ActiveJob* const job = Find(*std::exchange(next_, std::nullopt));
    const bool waits = job != nullptr && job->row.state == JobState::kQueued &&
                       job->run == nullptr && !job->place.has_value();
    if (waits) return Turn{.job = job->row};
  }
  const auto next = queue_.Take(MayBegin(tenants, room));
  if (!next.has_value()) return std::nullopt;
  queue_.Done(next->tenant);  // RunsOfTenants() counts it from here on
  ActiveJob& job = jobs_.at(next->item.job);
  job.place.reset();
  return Turn{.job = job.row, .ahead = room == Room::kAhead};
}

}  // namespace bccskel::server
