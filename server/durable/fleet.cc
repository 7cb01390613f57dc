#include <algorithm>
#include <chrono>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/durable/durable_jobs.h"
#include "server/errors/call_error.h"
#include "server/jobs/names.h"

namespace bccskel::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kBetweenBeats(1);
constexpr int kBeatsBetweenCounts = 10, kCleanUpsBetweenSweeps = 60;

}  // namespace

absl::Status DurableJobs::JoinFleet(JobStore& store) {
  BCCSKEL_RETURN_IF_ERROR(folder_.Join(store));
  BCCSKEL_RETURN_IF_ERROR(CountFiles(store));
  return store.Join(journal_.owner());
}

void DurableJobs::LookAfterFleet() {
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
  if (known != nullptr || !IsTerminal(job.state)) Apply(Step{.job = job, .event = std::nullopt});
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
  // What is older than the state is of an earlier attempt.
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

// It was cancelled first, but that is not to be read any more.
void DurableJobs::FollowDeleted(int64_t number) {
  const ActiveJob* const found = active_.Find(number);
  if (found == nullptr) return;
  JobRow job = found->row;
  job.state = JobState::kCancelled;
  ++job.sequence;
  job.ended = Now();
  Apply(Step{.job = job, .event = std::nullopt});
  watches_.Tell(number, {.sequence = job.sequence,
                         .time = *job.ended,
                         .what = JobEvent::StateChange{
                             .state = job.state, .attempt = job.attempts, .error = {}}});
  QueueWaiting();
}

void DurableJobs::QueueWaiting() {
  active_.QueueWaiting();
  retry_wanted_ = true;
}

void DurableJobs::Beat() {
  loop_.Post([](JobStore& store) { return store.Beat(); },
             [this, token = operations_.Begin()](const absl::Status& status) {
               if (!status.ok() || stopping_) return;
               LookAtMembers();
               QueueWaiting();
               if (++beats_ % kBeatsBetweenCounts == 0) CountFiles(loop_.store()).IgnoreError();
             },
             GroupCommit::Room::kReserve);
}

void DurableJobs::LookAtMembers() {
  const auto members = loop_.store().Members();
  if (!members.ok()) return;
  for (const Member& member : members_.Look(*members, journal_.owner(), Clock::now())) {
    TakeOverFrom(member);
  }
  // Who has left without its jobs, or was taken away in between, is gone for certain.
  std::set<std::string> gone;
  for (const auto& [number, job] : active_.jobs()) {
    const std::string& owner = job.row.owner;
    const bool here = owner == journal_.owner() || owner.empty();
    if (!here && !members_.Has(owner)) gone.insert(owner);
  }
  for (const std::string& owner : gone) TakeOverFrom({.server = owner, .beats = -1});
}

void DurableJobs::TakeOverFrom(const Member& member) {
  const auto steps = std::make_shared<std::vector<Step>>();
  loop_.Post(
      [this, member, steps](JobStore& store) -> absl::Status {
        steps->clear();
        BCCSKEL_ASSIGN_OR_RETURN(bool gone, store.Fence(member));
        if (!gone) {
          BCCSKEL_ASSIGN_OR_RETURN(const std::vector<Member> members, store.Members());
          gone = std::ranges::find(members, member.server, &Member::server) == members.end();
        }
        if (!gone) return absl::OkStatus();
        BCCSKEL_ASSIGN_OR_RETURN(std::vector<JobRow> jobs, store.UnfinishedJobs());
        for (JobRow& job : jobs) {
          if (job.state != JobState::kRunning || job.owner != member.server) continue;
          BCCSKEL_ASSIGN_OR_RETURN(const auto event, journal_.RecoverRunning(store, job));
          steps->push_back({.job = job, .event = event});
        }
        return absl::OkStatus();
      },
      [this, steps](const absl::Status& status) {
        if (!status.ok()) return;
        if (!steps->empty()) {
          options_.on_warning(absl::StrCat("another server is gone: ", steps->size(),
                                           " jobs that it ran go on elsewhere"));
        }
        for (const Step& step : *steps) Apply(step);
        QueueWaiting();
        Schedule();
      },
      GroupCommit::Room::kReserve);
}

void DurableJobs::Rejoin() {
  active_.ForgetRuns();
  uploads_.TakeAllAlong();
  retries_.clear();
  members_.Forget();
  journal_.SetOwner(RandomId());
  if (!loop_.store().Join(journal_.owner()).ok()) return;  // the next look tries again
  options_.on_warning("this server was silent for too long: others have taken over its jobs");
  Sync();
}

absl::Status DurableJobs::CountFiles(JobStore& store) {
  BCCSKEL_ASSIGN_OR_RETURN(auto used, store.DiskUse());
  quota_.Replace(std::move(used));
  return absl::OkStatus();
}

// Of files that nobody has named for so long; looked for without a transaction, which must be
// short.
void DurableJobs::SweepShared() {
  if (!shared_ || clean_ups_++ % kCleanUpsBetweenSweeps != 0) return;
  files_.Post({}, [this, token = operations_.Begin()] {
    const std::set<std::string> old = folder_.OldFiles();
    if (old.empty()) return;
    loop_.Post([this, old](JobStore& store) { return folder_.Sweep(store, old); }, nullptr,
               GroupCommit::Room::kReserve);
  });
}

// ---- Uploads

// An upload on its way from another server.
struct DurableJobs::Moving {
  UploadRow row;  // as it was
  std::string to;
  std::unique_ptr<UploadFile> file;
  bool opening = false;  // by this
  Done<Session> done;
};

void DurableJobs::WithSession(const std::string& tenant, const std::string& upload,
                              Done<Session> done) {
  const auto moving = std::make_shared<Moving>();
  moving->row.tenant = tenant;
  moving->row.name = upload;
  moving->done = std::move(done);
  loop_.Post([this, moving](JobStore& store) { return PrepareMove(store, *moving); },
             [this, moving](absl::Status status) {
               if (!status.ok()) return EndMove(moving, std::move(status));
               files_.Post({.tenant = moving->row.tenant}, [this, moving] { MoveUpload(moving); });
             });
}

absl::Status DurableJobs::PrepareMove(JobStore& store, Moving& moving) {
  BCCSKEL_ASSIGN_OR_RETURN(moving.row, store.Get<UploadRow>(moving.row.tenant, moving.row.name));
  if (!moving.row.volume.empty()) {
    return CallError(Reason::kUploadFinished, absl::StrCat(moving.row.name, " is finished"));
  }
  if (!shared_ || !uploads_.BeginOpening(moving.row)) {
    return CallError(Reason::kSecondWriter,
                     absl::StrCat(moving.row.name, " is being opened just now"));
  }
  moving.opening = true;
  moving.to = RandomId();
  return absl::OkStatus();
}

void DurableJobs::MoveUpload(const std::shared_ptr<Moving>& moving) {
  const std::string to = blobs_.PathOfUpload(moving->row.tenant, moving->row.name, moving->to);
  auto copy = UploadFile::Copy(blobs_.PathOf(moving->row), to);
  // Its server may not have come to making it.
  if (absl::IsNotFound(copy.status())) copy = UploadFile::Open(to);
  if (!copy.ok()) return EndMove(moving, copy.status());
  moving->file = *std::move(copy);
  loop_.Post([this, moving](JobStore& store) { return StoreMove(store, *moving); },
             [this, moving](absl::Status status) { EndMove(moving, std::move(status)); });
}

absl::Status DurableJobs::StoreMove(JobStore& store, Moving& moving) const {
  BCCSKEL_ASSIGN_OR_RETURN(UploadRow now, store.Get<UploadRow>(moving.row.tenant, moving.row.name));
  if (now.file != moving.row.file || !now.volume.empty()) {
    return CallError(Reason::kSecondWriter, absl::StrCat(now.name, " goes on on another server"));
  }
  BCCSKEL_RETURN_IF_ERROR(store.InsertRemoval(RemovalOf(now)));
  now.file = moving.to;
  return store.UpdateUpload(now);
}

void DurableJobs::EndMove(const std::shared_ptr<Moving>& moving, absl::Status status) {
  const UploadRow old = moving->row;
  if (!status.ok()) {
    if (moving->file != nullptr) {
      UploadFile::Remove(blobs_.PathOfUpload(old.tenant, old.name, moving->to)).IgnoreError();
    }
    if (moving->opening) uploads_.EndOpening(old);
    return moving->done(std::move(status));
  }
  moving->row.file = moving->to;
  const auto session = std::make_shared<UploadSession>(moving->row, std::move(moving->file), Now());
  uploads_.Add(session);
  UploadFile::Remove(blobs_.PathOf(old)).IgnoreError();  // else with the removals
  moving->done(session);
}

absl::Status DurableJobs::Superseded(const Session& session) {
  uploads_.RemoveFile(session->row());
  return CallError(Reason::kSecondWriter,
                   absl::StrCat(session->row().name, " goes on on another server"));
}

}  // namespace bccskel::server
