#include <algorithm>
#include <chrono>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/digest/random_id.h"
#include "core/exec/status_macros.h"
#include "server/durable/durable_jobs.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kBetweenBeats(1);
constexpr int kBeatsBetweenCounts = 10, kCleanUpsBetweenSweeps = 60;

}  // namespace

void DurableJobs::MaintainFleet() {
  JobStore& store = loop_.store();
  if (store.fenced()) return Rejoin();
  Sync();
  TellProgress();
  const Clock::time_point now = Clock::now();
  if (now - last_beat_ < kBetweenBeats) return;
  last_beat_ = now;
  Beat();
}

void DurableJobs::Sync() {
  if (!shared_) return;
  const auto changes = loop_.store().ChangesAfter(last_change_);
  if (!changes.ok()) return;
  last_change_ = changes->last;
  for (const JobRow& job : changes->jobs) Follow(job);
  for (const int64_t job : changes->deleted) FollowDeleted(job);
}

void DurableJobs::Follow(const JobRow& job) {
  const ActiveJob* const known = active_.Find(job.number);
  if (known != nullptr && known->row.sequence >= job.sequence) return;
  const bool ran = known != nullptr && known->row.state == JobState::kRunning;
  if (known != nullptr || !IsTerminal(job.state)) Apply(Step{job});
  if (ran && job.state != JobState::kRunning) QueueWaiting();
  TellStored(job.number);
}

void DurableJobs::TellStored(int64_t job) {
  if (!shared_ || !watches_.Has(job)) return;
  const auto events = loop_.store().EventsAfter(job, 0);
  if (!events.ok()) return watches_.End(job, absl::UnavailableError("its events cannot be read"));
  if (events->empty()) return watches_.End(job, absl::NotFoundError("the job was deleted"));
  for (const EventRow& event : *events) watches_.Tell(job, EventOf(event));
}

std::optional<JobEvent> DurableJobs::ProgressElsewhere(JobStore& store, const JobRow& job) const {
  if (!shared_ || job.state != JobState::kRunning || job.owner == journal_.owner()) return {};
  const auto found = store.FindProgress(job.number);
  // Progress older than the state belongs to an earlier attempt.
  if (!found.ok() || !found->has_value() || (*found)->sequence <= job.sequence) return {};
  const std::optional<JobProgress> progress = ProgressOfBytes((*found)->bytes);
  if (!progress.has_value()) return {};
  return JobEvent{.sequence = (*found)->sequence, .time = Now(), .what = *progress};
}

void DurableJobs::TellProgress() {
  for (const auto& [number, job] : active_.jobs()) {
    if (!watches_.Has(number)) continue;
    const std::optional<JobEvent> event = ProgressElsewhere(loop_.store(), job.row);
    if (event.has_value()) watches_.Tell(number, *event);
  }
}

// The job was cancelled before its deletion, but that event can no longer be read.
void DurableJobs::FollowDeleted(int64_t number) {
  const ActiveJob* const found = active_.Find(number);
  if (found == nullptr) return;
  JobRow job = found->row;
  job.state = JobState::kCancelled;
  job.error = JobCancelled();
  ++job.sequence;
  job.ended = Now();
  Apply(Step{job});
  watches_.Tell(number, {.sequence = job.sequence,
                         .time = *job.ended,
                         .what = JobEvent::StateChange{
                             .state = job.state, .attempt = job.attempts, .error = job.error}});
  QueueWaiting();
}

void DurableJobs::QueueWaiting() {
  active_.QueueWaiting();
  retry_wanted_ = true;
}

Flow DurableJobs::Beat() {
  const absl::Status status =
      co_await Commit([](JobStore& store) { return store.Beat(); }, GroupCommit::Room::kReserve);
  if (!status.ok() || stopping_) co_return;
  CheckMembers();
  QueueWaiting();
  if (++beats_ % kBeatsBetweenCounts == 0) CountFiles(loop_.store()).IgnoreError();
}

void DurableJobs::CheckMembers() {
  const auto members = loop_.store().Members();
  if (!members.ok()) return;
  for (const Member& member : members_.Look(*members, journal_.owner(), Clock::now())) {
    TakeOverFrom(member);
  }
  // A server that left without its jobs, or was removed in between, is certainly gone.
  std::set<std::string> gone;
  for (const auto& [number, job] : active_.jobs()) {
    const std::string& owner = job.row.owner;
    const bool here = owner == journal_.owner() || owner.empty();
    if (!here && !members_.Has(owner)) gone.insert(owner);
  }
  for (const std::string& owner : gone) TakeOverFrom({.server = owner, .beats = -1});
}

Flow DurableJobs::TakeOverFrom(Member member) {
  std::vector<Step> steps;
  const auto take_over = [&](JobStore& store) -> absl::Status {
    steps.clear();
    BCCSKEL_ASSIGN_OR_RETURN(bool gone, store.Fence(member));
    if (!gone) {
      BCCSKEL_ASSIGN_OR_RETURN(const std::vector<Member> members, store.Members());
      gone = std::ranges::find(members, member.server, &Member::server) == members.end();
    }
    if (!gone) return absl::OkStatus();
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<JobRow> jobs, store.UnfinishedJobs());
    for (const JobRow& job : jobs) {
      if (job.state != JobState::kRunning || job.owner != member.server) continue;
      BCCSKEL_ASSIGN_OR_RETURN(steps.emplace_back(), journal_.RecoverRunning(store, job));
    }
    return absl::OkStatus();
  };
  const absl::Status status = co_await Commit(take_over, GroupCommit::Room::kReserve);
  if (!status.ok()) co_return;
  if (!steps.empty()) {
    options_.on_warning(absl::StrCat("another server is gone: ", steps.size(),
                                     " jobs that it ran continue elsewhere"));
  }
  for (const Step& step : steps) Apply(step);
  QueueWaiting();
  Schedule();
}

void DurableJobs::Rejoin() {
  active_.ForgetRuns();
  uploads_.DetachAllDecoders();
  Retry(false);
  members_.Forget();
  journal_.SetOwner(RandomId());
  if (!loop_.store().Join(journal_.owner()).ok()) return;  // MaintainFleet() tries again
  options_.on_warning("this server was silent for too long: others have taken over its jobs");
  Sync();
}

absl::Status DurableJobs::CountFiles(JobStore& store) {
  BCCSKEL_ASSIGN_OR_RETURN(auto used, store.DiskUse());
  quota_.Replace(std::move(used));
  return absl::OkStatus();
}

// Sweeps files that no table has named for long. Lists them outside a transaction, which must be
// short.
Flow DurableJobs::SweepShared() {
  if (!shared_ || clean_ups_++ % kCleanUpsBetweenSweeps != 0) co_return;
  co_await ToFiles();
  const std::set<std::string> old = folder_.OldFiles();
  if (old.empty()) co_return;
  const absl::Status swept = co_await Commit(
      [&](JobStore& store) { return folder_.Sweep(store, old); }, GroupCommit::Room::kReserve);
  swept.IgnoreError();
}

// ---- Uploads

Flow DurableJobs::OpenSession(std::string tenant, std::string upload, Done<Session> done) {
  UploadRow row;
  absl::Status status = co_await Commit([&](JobStore& store) -> absl::Status {
    BCCSKEL_ASSIGN_OR_RETURN(row, store.Get<UploadRow>(tenant, upload));
    if (row.volume.empty()) return absl::OkStatus();
    return CallError(Reason::kUploadFinished, absl::StrCat(upload, " is finished"));
  });
  if (status.ok() && (!shared_ || !uploads_.BeginOpening(row))) {
    status = CallError(Reason::kSecondWriter, absl::StrCat(upload, " is being opened"));
  }
  if (!status.ok()) co_return done(std::move(status));
  const UploadRow old = row;
  row.file = RandomId();
  co_await ToFiles(tenant);
  auto copy = UploadFile::Copy(blobs_.PathOf(old), blobs_.PathOf(row));
  // The other server may not have created the file yet.
  if (absl::IsNotFound(copy.status())) copy = UploadFile::Open(blobs_.PathOf(row));
  status = copy.status();
  if (status.ok()) {
    status = co_await Commit([&](JobStore& store) { return StoreMove(store, old, row.file); });
    if (!status.ok()) UploadFile::Remove(blobs_.PathOf(row)).IgnoreError();
  }
  if (!status.ok()) {
    uploads_.EndOpening(old);
    co_return done(std::move(status));
  }
  const auto session = std::make_shared<UploadSession>(row, *std::move(copy), Now());
  uploads_.Add(session);
  UploadFile::Remove(blobs_.PathOf(old)).IgnoreError();  // if this fails, the removals do it
  done(session);
}

absl::Status DurableJobs::StoreMove(JobStore& store, const UploadRow& old, const std::string& to) {
  BCCSKEL_ASSIGN_OR_RETURN(UploadRow now, store.Get<UploadRow>(old.tenant, old.name));
  if (now.file != old.file || !now.volume.empty()) {
    return CallError(Reason::kSecondWriter, absl::StrCat(now.name, " continues on another server"));
  }
  BCCSKEL_RETURN_IF_ERROR(store.Put(RemovalRow{RemovalRow::Kind::kUpload, now.tenant, now.file}));
  now.file = to;
  return store.Put(now);
}

absl::Status DurableJobs::Superseded(const Session& session) {
  uploads_.Remove(session);
  return CallError(Reason::kSecondWriter,
                   absl::StrCat(session->row().name, " continues on another server"));
}

}  // namespace bccskel::server
