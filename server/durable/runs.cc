#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/admission/memory_estimate.h"
#include "server/durable/durable_jobs.h"
#include "server/durable/names.h"

namespace bccskel::server {
namespace {

// Results that are computed and not stored yet: they hold memory.
constexpr int kMostUnstored = 16;

}  // namespace

std::string DurableJobs::ResultKey(const std::string& volume_digest,
                                   const std::string& options) const {
  return KeyOf({volume_digest, options, options_.algorithm_version});
}

// A suspect stands back as if it had come ten minutes after it began to run.
void DurableJobs::Enqueue(ActiveJob& job) {
  constexpr std::chrono::minutes kCostOfCrash(10);
  if (job.place.has_value()) return;
  const JobRow& row = job.row;
  const bool suspect = row.crashes > 0;
  const Time came = suspect ? row.started.value_or(row.created) : row.created;
  job.place =
      queue_.Push({.tenant = row.tenant, .priority = PriorityOf(row)},
                  came + row.crashes * kCostOfCrash, {.job = row.number, .suspect = suspect});
}

void DurableJobs::Dequeue(ActiveJob& job) {
  if (job.place.has_value()) queue_.Remove(*std::exchange(job.place, std::nullopt));
}

void DurableJobs::Schedule() {
  // Others of the fleet begin what this one would not end.
  while (!stopping_ && (admitting_ || !shared_) && BeginNext() == Begun::kYes) {
  }
}

std::map<std::string, int> DurableJobs::RunsOfTenants() const {
  std::map<std::string, int> runs;
  for (const auto& [pointer, run] : runs_) {
    if (!run.volume.empty()) ++runs[run.tenant];  // it has come
  }
  if (!shared_) return runs;
  for (const auto& [number, job] : active_) {
    const bool elsewhere = job.row.state == JobState::kRunning && job.run == nullptr;
    if (elsewhere) ++runs[job.row.tenant];
  }
  return runs;
}

int DurableJobs::CountRunsFromFiles(std::function<bool(const ActiveRun&)> which) const {
  return static_cast<int>(std::ranges::count_if(runs_, [&](const auto& entry) {
    return entry.second.source == ActiveRun::Source::kFile && which(entry.second);
  }));
}

// Suspects run one at a time: a crash makes one of them more suspect and no more, and those that
// are innocent soon show it.
DurableJobs::Begun DurableJobs::BeginNext() {
  const int at_runner = CountRunsFromFiles([](const ActiveRun& run) { return !run.computed; });
  const int unstored = CountRunsFromFiles([](const ActiveRun& run) { return run.computed; });
  const bool ahead = at_runner >= options_.max_runs;
  if (at_runner >= options_.max_runs + pace_.Ahead() || unstored > kMostUnstored) {
    return Begun::kNothingNow;
  }
  if (next_.has_value() && ahead) return Begun::kNothingNow;
  if (next_.has_value()) {
    const auto job = active_.find(*std::exchange(next_, std::nullopt));
    const bool waits = job != active_.end() && job->second.row.state == JobState::kQueued &&
                       job->second.run == nullptr && !job->second.place.has_value();
    return waits ? BeginJob(JobRow(job->second.row), ahead) : Begun::kYes;
  }
  const bool one_is_suspect =
      CountRunsFromFiles([](const ActiveRun& run) { return run.crashes > 0; }) > 0;
  queue_.SetLimits(options_.tenants());
  queue_.SetAtWorkElsewhere(RunsOfTenants());
  const auto next =
      queue_.Take([=](const WaitingJob& job) { return !job.suspect || !one_is_suspect; });
  if (!next.has_value()) return Begun::kNothingNow;
  queue_.Done(next->tenant);  // RunsOfTenants() counts it from here on
  ActiveJob& job = active_.at(next->item.job);
  job.place.reset();
  return BeginJob(JobRow(job.row), ahead);
}

DurableJobs::Begun DurableJobs::BeginJob(const JobRow& job, bool ahead) {
  JobStore& store = loop_.store();
  const auto volume = store.FindVolume(job.tenant, job.volume);
  if (!volume.ok()) {
    Enqueue(active_.at(job.number));
    retry_wanted_ = true;
    return Begun::kNothingNow;
  }
  if (!volume->has_value()) {
    EnterState({job.number}, JobState::kFailed,
               absl::DataLossError(absl::StrCat(job.volume, " is gone")), 0, nullptr);
    return Begun::kYes;
  }
  if (!(*volume)->volume_digest.empty()) {
    const std::string key = ResultKey((*volume)->volume_digest, job.options);
    const auto stored = store.FindResultOf(job.tenant, key);
    if (stored.ok() && stored->has_value()) {
      WithWholeResult(job.tenant, key, [this, job](const std::optional<ResultRow>& result) {
        const auto active = active_.find(job.number);
        if (active == active_.end()) return;
        if (!result.has_value()) {
          Enqueue(active->second);
          retry_wanted_ = true;
          return;
        }
        ++cached_;
        EnterState({job.number}, JobState::kSucceeded, absl::OkStatus(), result->number, nullptr);
      });
      return Begun::kYes;
    }
  }
  if (ActiveRun* equal = EqualRun(job, **volume); equal != nullptr) {
    Attach(*equal, job.number);
    Claim(job.number, nullptr, nullptr);
    return Begun::kYes;
  }
  return StartRun(job, **volume, ahead);
}

ActiveRun* DurableJobs::EqualRun(const JobRow& job, const VolumeRow& volume) {
  for (auto& [pointer, run] : runs_) {
    const bool same_volume =
        !run.volume.empty() &&
        (run.volume == volume.name ||
         (!run.volume_digest.empty() && run.volume_digest == volume.volume_digest));
    if (same_volume && !run.ending && run.tenant == job.tenant && run.options == job.options) {
      return &run;
    }
  }
  return nullptr;
}

DurableJobs::Begun DurableJobs::StartRun(const JobRow& job, const VolumeRow& volume, bool ahead) {
  absl::StatusOr<JobRequest> request = codec_.RequestOf(volume.declaration, job.options);
  // A large one would wait here for long, which another server could begin at once.
  if (ahead && request.ok() && request->header.max_bricks > kSmallJobBricks) {
    next_ = job.number;
    return Begun::kNothingNow;
  }
  const auto run = std::make_shared<Run>(*this, job.tenant, operations_.Begin());
  absl::Status started = request.status();
  if (started.ok()) started = run->Start(runner_, RunnerRequest(*std::move(request), job));
  if (absl::IsUnavailable(started)) {
    Enqueue(active_.at(job.number));
    retry_wanted_ = true;
    return Begun::kNothingNow;
  }
  if (!started.ok()) {
    EnterState({job.number}, JobState::kFailed, started, 0, nullptr);
    return Begun::kYes;
  }
  ActiveRun& active = AddRun(run, job, ActiveRun::Source::kFile);
  active.volume = volume.name;
  active.volume_digest = volume.volume_digest;
  active.crashes = job.crashes;
  Attach(active, job.number);
  // The attempt is counted before it begins.
  Claim(job.number, &volume, [this, run, volume] { Feed(run.get(), volume); });
  return Begun::kYes;
}

struct DurableJobs::Claiming {
  enum class Outcome { kMine, kOthers, kEqualRunsElsewhere };
  int64_t job = 0;
  std::optional<VolumeRow> volume;
  std::shared_ptr<Run> fed;  // the run that is to have its bytes
  std::function<void()> then;
  Outcome outcome = Outcome::kOthers;
  std::vector<Step> steps;
};

void DurableJobs::Claim(int64_t job, const VolumeRow* volume, std::function<void()> then) {
  const auto claiming = std::make_shared<Claiming>();
  claiming->job = job;
  const auto active = active_.find(job);
  if (volume != nullptr) claiming->volume = *volume;
  if (volume != nullptr && active != active_.end() && active->second.run != nullptr) {
    claiming->fed = runs_.at(active->second.run).run;
  }
  claiming->then = std::move(then);
  loop_.Post([this, claiming](JobStore& store) { return ClaimStored(store, *claiming); },
             [this, claiming](const absl::Status& status) {
               if (status.ok()) return Claimed(*claiming);
               RetryLater([this, claiming] {
                 const VolumeRow* const fed = claiming->volume ? &*claiming->volume : nullptr;
                 Claim(claiming->job, fed, claiming->then);
               });
             },
             GroupCommit::Room::kReserve);
}

absl::Status DurableJobs::ClaimStored(JobStore& store, Claiming& claiming) {
  using Outcome = Claiming::Outcome;
  claiming.steps.clear();
  claiming.outcome = Outcome::kOthers;
  const auto active = active_.find(claiming.job);
  if (active == active_.end() || active->second.run == nullptr) return absl::OkStatus();
  JobRow job = active->second.row;
  bool elsewhere = false;
  if (claiming.volume.has_value() && shared_) {
    BCCSKEL_ASSIGN_OR_RETURN(elsewhere, store.RunsElsewhere(job, claiming.volume->volume_digest,
                                                            journal_.owner()));
    if (elsewhere) claiming.outcome = Outcome::kEqualRunsElsewhere;
  }
  std::optional<EventRow> event;
  if (job.state == JobState::kQueued && !elsewhere) {
    BCCSKEL_ASSIGN_OR_RETURN(event, journal_.Enter(store, job, JobState::kRunning, absl::OkStatus(),
                                                   JobJournal::Found::kBefore));
  }
  if (!event.has_value()) {
    BCCSKEL_ASSIGN_OR_RETURN(const auto stored, store.FindJob(job.tenant, job.name));
    if (!stored.has_value()) return absl::OkStatus();
    job = *stored;
    // A commit that seemed to have failed may have happened.
    const bool is_mine = job.state == JobState::kRunning && job.owner == journal_.owner();
    if (!is_mine && (elsewhere || job.state != JobState::kQueued)) return absl::OkStatus();
    if (!is_mine) {
      BCCSKEL_ASSIGN_OR_RETURN(event, journal_.Enter(store, job, JobState::kRunning));
    }
  }
  claiming.outcome = Outcome::kMine;
  claiming.steps.push_back({.job = job, .event = event});
  return absl::OkStatus();
}

void DurableJobs::Claimed(const Claiming& claiming) {
  for (const Step& step : claiming.steps) Apply(step);
  if (claiming.outcome == Claiming::Outcome::kMine) {
    if (claiming.then) claiming.then();
    return Schedule();
  }
  // Others that joined the run would wait for its bytes for ever: they are queued again.
  if (claiming.fed != nullptr) claiming.fed->Cancel();
  Detach(claiming.job);
  Sync();
  const auto active = active_.find(claiming.job);
  const bool waits = active != active_.end() && active->second.row.state == JobState::kQueued;
  if (waits && claiming.outcome == Claiming::Outcome::kEqualRunsElsewhere) {
    waits_for_equal_.insert(claiming.job);
    Dequeue(active->second);
  } else if (waits) {
    waits_for_equal_.insert(claiming.job);  // the store could not tell whose it is
  }
  Schedule();
}

ActiveRun& DurableJobs::AddRun(std::shared_ptr<Run> run, const JobRow& job,
                               ActiveRun::Source source) {
  ActiveRun& active = runs_[run.get()];
  active.run = std::move(run);
  active.source = source;
  active.tenant = job.tenant;
  active.options = job.options;
  return active;
}

void DurableJobs::Attach(ActiveRun& run, int64_t job) {
  run.jobs.insert(job);
  active_.at(job).run = run.run.get();
}

void DurableJobs::Detach(int64_t job) {
  const auto found = active_.find(job);
  if (found == active_.end() || found->second.run == nullptr) return;
  const auto run = runs_.find(std::exchange(found->second.run, nullptr));
  if (run == runs_.end()) return;
  run->second.jobs.erase(job);
  if (run->second.jobs.empty() && !run->second.ending) run->second.run->Cancel();
}

void DurableJobs::Feed(Run* pointer, const VolumeRow& volume) {
  const auto found = runs_.find(pointer);
  if (found == runs_.end()) return;  // nobody wants it any more
  found->second.fed = RunPace::Clock::now();
  files_.Post({.tenant = volume.tenant}, [this, run = found->second.run, volume] {
    absl::StatusOr<CheckedFile> file = blobs_.OpenBlob(volume.tenant, volume.blob_digest);
    if (!file.ok()) return run->Fail(file.status());
    run->Feed(*std::move(file), files_);
  });
}

void DurableJobs::ForgetRun(Run* run) {
  const auto found = runs_.find(run);
  if (found == runs_.end()) return;
  for (const int64_t job : found->second.jobs) {
    const auto active = active_.find(job);
    if (active != active_.end() && active->second.run == run) active->second.run = nullptr;
  }
  runs_.erase(found);
}

absl::Status DurableJobs::EnterState(JobStore& store, int64_t number, JobState state,
                                     const absl::Status& error, int64_t result,
                                     std::vector<Step>& steps) {
  const auto active = active_.find(number);
  if (active == active_.end()) return absl::OkStatus();
  const auto is_ours = [this](const JobRow& job) {
    return !IsTerminal(job.state) &&
           (job.state != JobState::kRunning || job.owner == journal_.owner());
  };
  JobRow job = active->second.row;
  job.result = result;
  std::optional<EventRow> event;
  if (is_ours(job)) {
    BCCSKEL_ASSIGN_OR_RETURN(
        event, journal_.Enter(store, job, state, error, JobJournal::Found::kBefore));
  }
  if (!event.has_value()) {
    BCCSKEL_ASSIGN_OR_RETURN(const auto stored, store.FindJob(job.tenant, job.name));
    if (!stored.has_value() || !is_ours(*stored)) return absl::OkStatus();
    job = *stored;
    job.result = result;
    BCCSKEL_ASSIGN_OR_RETURN(event, journal_.Enter(store, job, state, error));
  }
  if (event.has_value()) steps.push_back({.job = job, .event = event});
  return absl::OkStatus();
}

void DurableJobs::EnterState(std::set<int64_t> jobs, JobState state, const absl::Status& error,
                             int64_t result, std::function<void()> then) {
  const auto steps = std::make_shared<std::vector<Step>>();
  loop_.Post(
      [this, jobs, state, error, result, steps](JobStore& store) -> absl::Status {
        steps->clear();
        for (const int64_t job : jobs) {
          BCCSKEL_RETURN_IF_ERROR(EnterState(store, job, state, error, result, *steps));
        }
        return absl::OkStatus();
      },
      [this, jobs, state, error, result, steps, then](const absl::Status& status) {
        if (!status.ok()) {
          return RetryLater([=, this] { EnterState(jobs, state, error, result, then); });
        }
        for (const Step& step : *steps) Apply(step);
        if (then) then();
        Schedule();
      },
      GroupCommit::Room::kReserve);
}

void DurableJobs::RetryLater(std::function<void()> task) {
  if (stopping_) return;
  retries_.push_back(std::move(task));
  retry_wanted_ = true;
}

}  // namespace bccskel::server
