#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/admission/memory_estimate.h"
#include "server/durable/durable_jobs.h"
#include "server/jobs/names.h"

namespace bccskel::server {
// A job that is to run here. With a run that has to be fed its volume, or none: it joins one.
struct DurableJobs::Claiming {
  enum class Outcome { kMine, kOthers, kEqualRunsElsewhere };
  int64_t job = 0;
  std::optional<VolumeRow> volume = std::nullopt;
  std::shared_ptr<Run> fed = nullptr;
  Outcome outcome = Outcome::kOthers;
  std::vector<Step> steps = {};
};

std::string DurableJobs::ResultKey(const std::string& volume_digest,
                                   const std::string& options) const {
  return KeyOf({volume_digest, options, options_.algorithm_version});
}

// Who is next is decided within the transaction that stores it: others of the fleet do the same.
void DurableJobs::Schedule() {
  // Others of the fleet begin what this one would not end.
  if (scheduling_ || stopping_ || (!admitting_ && shared_)) return;
  if (!active_.HasNext(options_.tenants(), options_.max_runs)) return;
  scheduling_ = true;
  const auto claims = std::make_shared<Claims>();
  loop_.Post([this, claims](JobStore& store) { return BeginNext(store, *claims); },
             [this, claims](const absl::Status& status) {
               scheduling_ = false;
               if (!status.ok()) retry_wanted_ = true;
               for (const auto& claiming : claims->all) EndClaim(claiming, status);
               // Others may have come since it looked.
               if (status.ok() && !claims->blocked) Schedule();
             },
             GroupCommit::Room::kReserve);
}

absl::Status DurableJobs::BeginNext(JobStore& store, Claims& claims) {
  for (const auto& claiming : claims.all) {  // of a transaction that has failed
    BCCSKEL_RETURN_IF_ERROR(ClaimStored(store, *claiming));
  }
  while (!stopping_) {
    const auto turn = active_.TakeNext(options_.tenants(), options_.max_runs);
    if (!turn.has_value()) break;
    BCCSKEL_ASSIGN_OR_RETURN(const Begun begun, BeginJob(store, *turn, claims));
    claims.blocked = begun == Begun::kNothingNow;
    if (claims.blocked) break;
  }
  return absl::OkStatus();
}

absl::StatusOr<DurableJobs::Begun> DurableJobs::BeginJob(JobStore& store,
                                                         const ActiveJobs::Turn& turn,
                                                         Claims& claims) {
  const JobRow& job = turn.job;
  const auto volume = store.Find<VolumeRow>(job.tenant, job.volume);
  if (!volume.ok()) {
    WaitAgain(job.number);
    return volume.status();
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
      GiveWholeResult(job, key);
      return Begun::kYes;
    }
  }
  if (ActiveRun* equal = active_.FindEqual(job, **volume); equal != nullptr) {
    active_.Attach(*equal, job.number);
    claims.all.push_back(std::make_shared<Claiming>(Claiming{.job = job.number}));
  } else {
    const Begun started = StartRun(turn, **volume, claims);
    if (started != Begun::kClaim) return started;
  }
  BCCSKEL_RETURN_IF_ERROR(ClaimStored(store, *claims.all.back()));
  return Begun::kYes;
}

void DurableJobs::GiveWholeResult(const JobRow& job, const std::string& key) {
  WithWholeResult(
      job.tenant, key, [this, number = job.number](const std::optional<ResultRow>& result) {
        if (active_.Find(number) == nullptr) return;
        if (!result.has_value()) {
          WaitAgain(number);
          return;
        }
        ++cached_;
        EnterState({number}, JobState::kSucceeded, absl::OkStatus(), result->number, nullptr);
      });
}

DurableJobs::Begun DurableJobs::WaitAgain(int64_t job) {
  active_.Enqueue(*active_.Find(job));
  retry_wanted_ = true;
  return Begun::kNothingNow;
}

DurableJobs::Begun DurableJobs::StartRun(const ActiveJobs::Turn& turn, const VolumeRow& volume,
                                         Claims& claims) {
  const JobRow& job = turn.job;
  absl::StatusOr<JobRequest> request = codec_.RequestOf(volume.declaration, job.options);
  // A large one would wait here for long, which another server could begin at once.
  if (turn.ahead && request.ok() && request->header.max_bricks > kSmallJobBricks) {
    active_.WaitForPlace(job.number);
    return Begun::kNothingNow;
  }
  const auto run = std::make_shared<Run>(*this, job.tenant, operations_.Begin());
  absl::Status started = request.status();
  if (started.ok()) started = run->Start(runner_, RunnerRequest(*std::move(request), job));
  if (absl::IsUnavailable(started)) return WaitAgain(job.number);
  if (!started.ok()) {
    EnterState({job.number}, JobState::kFailed, started, 0, nullptr);
    return Begun::kYes;
  }
  ActiveRun& active = active_.AddRun(run, job, ActiveRun::Source::kFile);
  active.volume = volume.name;
  active.volume_digest = volume.volume_digest;
  active.crashes = job.crashes;
  active_.Attach(active, job.number);
  // The attempt is counted before it begins.
  claims.all.push_back(
      std::make_shared<Claiming>(Claiming{.job = job.number, .volume = volume, .fed = run}));
  return Begun::kClaim;
}

// The store did not take what was begun: again, until it does.
void DurableJobs::Claim(const std::shared_ptr<Claiming>& claiming) {
  loop_.Post([this, claiming](JobStore& store) { return ClaimStored(store, *claiming); },
             [this, claiming](const absl::Status& status) { EndClaim(claiming, status); },
             GroupCommit::Room::kReserve);
}

void DurableJobs::EndClaim(const std::shared_ptr<Claiming>& claiming, const absl::Status& status) {
  if (status.ok()) return Claimed(*claiming);
  RetryLater([this, claiming] { Claim(claiming); });
}

absl::Status DurableJobs::ClaimStored(JobStore& store, Claiming& claiming) {
  using Outcome = Claiming::Outcome;
  claiming.steps.clear();
  claiming.outcome = Outcome::kOthers;
  const ActiveJob* const active = active_.Find(claiming.job);
  if (active == nullptr || active->run == nullptr) return absl::OkStatus();
  JobRow job = active->row;
  bool elsewhere = false;
  if (claiming.volume.has_value() && shared_) {
    BCCSKEL_ASSIGN_OR_RETURN(
        elsewhere, store.RunsElsewhere(job, claiming.volume->volume_digest, journal_.owner()));
    if (elsewhere) claiming.outcome = Outcome::kEqualRunsElsewhere;
  }
  std::optional<EventRow> event;
  if (job.state == JobState::kQueued && !elsewhere) {
    BCCSKEL_ASSIGN_OR_RETURN(event, journal_.Enter(store, job, JobState::kRunning, absl::OkStatus(),
                                                   JobJournal::Found::kBefore));
  }
  if (!event.has_value()) {
    BCCSKEL_ASSIGN_OR_RETURN(const auto stored, store.Find<JobRow>(job.tenant, job.name));
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
    if (claiming.fed != nullptr) Feed(claiming.fed.get(), *claiming.volume);
    return Schedule();
  }
  // Others that joined the run would wait for its bytes for ever: they are queued again.
  if (claiming.fed != nullptr) claiming.fed->Cancel();
  active_.Detach(claiming.job);
  Sync();
  ActiveJob* const active = active_.Find(claiming.job);
  const bool waits = active != nullptr && active->row.state == JobState::kQueued;
  const bool equal = claiming.outcome == Claiming::Outcome::kEqualRunsElsewhere;
  // Without a place the store could not tell whose it is.
  if (waits && (equal || !active->place.has_value())) active_.WaitForEqual(*active);
  Schedule();
}

void DurableJobs::Feed(Run* pointer, const VolumeRow& volume) {
  ActiveRun* const found = active_.FindRun(pointer);
  if (found == nullptr) return;  // nobody wants it any more
  found->fed = RunPace::Clock::now();
  files_.Post({.tenant = volume.tenant}, [this, run = found->run, volume] {
    const std::string path = blobs_.PathOfBlob(volume.tenant, volume.blob_digest);
    absl::StatusOr<CheckedFile> file = CheckedFile::Open(path, volume.blob_digest);
    if (!file.ok()) return run->Fail(file.status());
    run->Feed(*std::move(file), files_);
  });
}

absl::Status DurableJobs::EnterState(JobStore& store, int64_t number, JobState state,
                                     const absl::Status& error, int64_t result,
                                     std::vector<Step>& steps) {
  const ActiveJob* const active = active_.Find(number);
  if (active == nullptr) return absl::OkStatus();
  const auto is_ours = [this](const JobRow& job) {
    return !IsTerminal(job.state) &&
           (job.state != JobState::kRunning || job.owner == journal_.owner());
  };
  JobRow job = active->row;
  job.result = result;
  std::optional<EventRow> event;
  if (is_ours(job)) {
    BCCSKEL_ASSIGN_OR_RETURN(event,
                             journal_.Enter(store, job, state, error, JobJournal::Found::kBefore));
  }
  if (!event.has_value()) {
    BCCSKEL_ASSIGN_OR_RETURN(const auto stored, store.Find<JobRow>(job.tenant, job.name));
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
