#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/admission/memory_estimate.h"
#include "server/durable/durable_jobs.h"
#include "server/jobs/names.h"

namespace bccskel::server {

// A job claimed for this server. `fed` is its new run, which needs the volume; null: it joins a
// run.
struct DurableJobs::Claiming {
  enum class Outcome { kMine, kOthers, kEqualRunsElsewhere };
  int64_t job = 0;
  std::optional<VolumeRow> volume = std::nullopt;
  std::shared_ptr<Run> fed = nullptr;
  Outcome outcome = Outcome::kOthers;
  std::optional<Step> step = std::nullopt;
};

struct DurableJobs::Claims {
  std::vector<Claiming> all;
  bool blocked = false;  // the next job cannot begin now
};

std::string DurableJobs::ResultKey(const std::string& volume_digest,
                                   const std::string& options) const {
  return KeyOf({volume_digest, options, options_.algorithm_version});
}

// Chooses the next jobs within the transaction that claims them, because other servers of the fleet
// choose from the same queue.
void DurableJobs::Schedule() {
  // A draining server leaves the jobs to the rest of the fleet.
  if (scheduling_ || stopping_ || (!admitting_ && shared_)) return;
  if (active_.HasNext(options_.tenants(), options_.max_runs)) {
    BeginJobs();
  } else if (active_.HasWaiting()) {
    retry_wanted_ = true;
  }
}

Flow DurableJobs::BeginJobs() {
  scheduling_ = true;
  Claims claims;
  const absl::Status status = co_await Commit(
      [&](JobStore& store) { return BeginNext(store, claims); }, GroupCommit::Room::kReserve);
  scheduling_ = false;
  if (!status.ok()) retry_wanted_ = true;
  for (const Claiming& claiming : claims.all) {
    if (status.ok()) {
      Claimed(claiming);
    } else {
      ClaimAgain(claiming);
    }
  }
  // More jobs may have arrived in the meantime.
  if (status.ok() && !claims.blocked) Schedule();
}

absl::Status DurableJobs::BeginNext(JobStore& store, Claims& claims) {
  for (Claiming& claiming : claims.all) {  // of a failed attempt of this transaction
    BCCSKEL_RETURN_IF_ERROR(Claim(store, claiming));
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
  if (absl::IsDataLoss(volume.status())) {  // else this job would be the next one forever
    EnterState({job.number}, JobState::kFailed, volume.status());
    return Begun::kYes;
  }
  if (!volume.ok()) {
    WaitAgain(job.number);
    return volume.status();
  }
  if (!volume->has_value()) {
    EnterState({job.number}, JobState::kFailed,
               absl::DataLossError(absl::StrCat(job.volume, " is gone")));
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
    claims.all.push_back({.job = job.number});
  } else {
    const Begun started = StartRun(turn, **volume, claims);
    if (started != Begun::kClaim) return started;
  }
  BCCSKEL_RETURN_IF_ERROR(Claim(store, claims.all.back()));
  return Begun::kYes;
}

Flow DurableJobs::GiveWholeResult(JobRow job, std::string key) {
  const std::optional<ResultRow> result = co_await WholeResult(job.tenant, key);
  if (active_.Find(job.number) == nullptr) co_return;
  if (!result.has_value()) co_return WaitAgain(job.number);
  ++cached_;
  EnterState({job.number}, JobState::kSucceeded, absl::OkStatus(), result->number);
}

void DurableJobs::WaitAgain(int64_t job) {
  active_.Enqueue(*active_.Find(job));
  retry_wanted_ = true;
}

DurableJobs::Begun DurableJobs::StartRun(const ActiveJobs::Turn& turn, const VolumeRow& volume,
                                         Claims& claims) {
  const JobRow& job = turn.job;
  absl::StatusOr<JobRequest> request = codec_.RequestOf(volume.declaration, job.options);
  // A large job would wait here for long, while another server could begin it at once.
  if (turn.ahead && request.ok() && request->header.max_bricks > kSmallJobBricks) {
    active_.WaitForPlace(job.number);
    return Begun::kNothingNow;
  }
  const auto run = std::make_shared<Run>(*this, job.tenant, BeginOperation());
  absl::Status started = request.status();
  if (started.ok()) started = run->Start(runner_, RunnerRequest(*std::move(request), job));
  if (absl::IsUnavailable(started)) {
    WaitAgain(job.number);
    return Begun::kNothingNow;
  }
  if (!started.ok()) {
    EnterState({job.number}, JobState::kFailed, started);
    return Begun::kYes;
  }
  ActiveRun& active = active_.AddRun(run, job, ActiveRun::Source::kFile);
  active.volume = volume.name;
  active.volume_digest = volume.volume_digest;
  active.crashes = job.crashes;
  active_.Attach(active, job.number);
  // Stores the attempt before it begins.
  claims.all.push_back({.job = job.number, .volume = volume, .fed = run});
  return Begun::kClaim;
}

// Repeats a claim that could not be stored until it succeeds.
Flow DurableJobs::ClaimAgain(Claiming claiming) {
  absl::Status status;
  do {
    if (!co_await Later()) co_return;
    status = co_await Commit([&](JobStore& store) { return Claim(store, claiming); },
                             GroupCommit::Room::kReserve);
  } while (!status.ok());
  Claimed(claiming);
}

absl::Status DurableJobs::Claim(JobStore& store, Claiming& claiming) {
  using Outcome = Claiming::Outcome;
  claiming.step.reset();
  claiming.outcome = Outcome::kOthers;
  const ActiveJob* const active = active_.Find(claiming.job);
  if (active == nullptr || active->run == nullptr) return absl::OkStatus();
  const JobRow& job = active->row;
  bool elsewhere = false;
  if (claiming.volume.has_value() && shared_) {
    BCCSKEL_ASSIGN_OR_RETURN(
        elsewhere, store.RunsElsewhere(job, claiming.volume->volume_digest, journal_.owner()));
    if (elsewhere) claiming.outcome = Outcome::kEqualRunsElsewhere;
  }
  BCCSKEL_ASSIGN_OR_RETURN(
      claiming.step, journal_.EnterRemembered(store, job, JobState::kRunning, absl::OkStatus(),
                                              job.result, [elsewhere](const JobRow& row) {
                                                return row.state == JobState::kQueued && !elsewhere;
                                              }));
  if (!claiming.step.has_value()) {
    // A commit that appeared to fail may have succeeded.
    BCCSKEL_ASSIGN_OR_RETURN(const auto stored, store.Find<JobRow>(job.tenant, job.name));
    const bool is_mine = stored.has_value() && stored->state == JobState::kRunning &&
                         stored->owner == journal_.owner();
    if (is_mine) claiming.step = Step{*stored};
  }
  if (claiming.step.has_value()) claiming.outcome = Outcome::kMine;
  return absl::OkStatus();
}

void DurableJobs::Claimed(const Claiming& claiming) {
  if (claiming.step.has_value()) Apply(*claiming.step);
  if (claiming.outcome == Claiming::Outcome::kMine) {
    if (claiming.fed != nullptr) Feed(claiming.fed, *claiming.volume);
    Schedule();
    return;
  }
  // Other jobs that joined the run would wait for its bytes forever: they are queued again.
  if (claiming.fed != nullptr) claiming.fed->Cancel();
  active_.Detach(claiming.job);
  Sync();
  ActiveJob* const active = active_.Find(claiming.job);
  const bool waits = active != nullptr && active->row.state == JobState::kQueued;
  const bool equal = claiming.outcome == Claiming::Outcome::kEqualRunsElsewhere;
  // Without a place in the queue Sync() could not read the job's owner from the store.
  if (waits && (equal || !active->place.has_value())) active_.WaitForEqual(*active);
  Schedule();
}

Flow DurableJobs::Feed(std::shared_ptr<Run> run, VolumeRow volume) {
  ActiveRun* const found = active_.FindRun(run.get());
  if (found == nullptr) co_return;  // no job needs it any more
  found->fed = RunPace::Clock::now();
  co_await ToFiles(volume.tenant);
  auto file = CheckedFile::Open(blobs_.PathOf(volume), volume.blob_digest);
  absl::Status status = file.status();
  while (status.ok()) {
    absl::StatusOr<std::string> bytes = file->Next();
    if (!bytes.ok()) co_return run->Fail(bytes.status());
    if (bytes->empty()) co_return run->FinishVolume();
    status =
        co_await Await<absl::Status>([&](auto resume) { run->Append(*std::move(bytes), resume); });
    co_await ToFiles(volume.tenant);
  }
  run->Fail(status);
}

absl::Status DurableJobs::StoreState(JobStore& store, int64_t number, JobState state,
                                     const absl::Status& error, int64_t result,
                                     std::vector<Step>& steps) {
  const ActiveJob* const active = active_.Find(number);
  if (active == nullptr) return absl::OkStatus();
  BCCSKEL_ASSIGN_OR_RETURN(
      const auto step,
      journal_.EnterRemembered(store, active->row, state, error, result, [this](const JobRow& job) {
        const bool ours = job.state != JobState::kRunning || job.owner == journal_.owner();
        return ours && !IsTerminal(job.state);
      }));
  if (step.has_value() && step->event.has_value()) steps.push_back(*step);
  return absl::OkStatus();
}

Flow DurableJobs::EnterState(std::set<int64_t> jobs, JobState state, absl::Status error,
                             int64_t result) {
  std::vector<Step> steps;
  const auto change = [&](JobStore& store) -> absl::Status {
    steps.clear();
    for (const int64_t job : jobs) {
      BCCSKEL_RETURN_IF_ERROR(StoreState(store, job, state, error, result, steps));
    }
    return absl::OkStatus();
  };
  while (!(co_await Commit(change, GroupCommit::Room::kReserve)).ok()) {
    if (!co_await Later()) co_return;
  }
  for (const Step& step : steps) Apply(step);
  Schedule();
}

}  // namespace bccskel::server
