#include <utility>

#include "core/exec/status_macros.h"
#include "server/durable/durable_jobs.h"
#include "server/errors/call_error.h"

namespace bccskel::server {

Flow DurableJobs::OnRunVolume(std::shared_ptr<Run> run, std::string digest) {
  co_await ToLoop();
  ActiveRun* const found = active_.FindOpen(run.get());
  // If the digest was known before, the search is done.
  if (found == nullptr || found->volume_digest == digest) co_return;
  found->volume_digest = digest;
  const std::string tenant = found->tenant, volume = found->volume;
  const std::string key = ResultKey(digest, found->options);
  const absl::Status noted = co_await Commit([&](JobStore& store) -> absl::Status {
    BCCSKEL_ASSIGN_OR_RETURN(std::optional<VolumeRow> row, store.Find<VolumeRow>(tenant, volume));
    if (!row.has_value() || row->volume_digest == digest) return absl::OkStatus();
    row->volume_digest = digest;
    return store.Put(*row);
  });
  noted.IgnoreError();
  const std::optional<ResultRow> result = co_await WholeResult(tenant, key);
  if (result.has_value()) co_return GiveStoredResult(run.get(), result->number);
  JoinEqual(run.get());
}

Flow DurableJobs::ReadResult(std::string tenant, std::string key,
                             std::function<void(std::optional<ResultRow>)> then) {
  const auto stored = loop_.store().FindResultOf(tenant, key);
  if (!stored.ok() || !stored->has_value()) co_return then(std::nullopt);
  const ResultRow row = **stored;
  co_await ToFiles(tenant);
  const absl::Status whole = blobs_.OpenResult(row.tenant, row.file, row.file_digest).status();
  if (whole.ok() || absl::IsUnavailable(whole)) {  // it cannot be read at the moment
    co_await ToLoop();
  } else {
    co_await Dropped(row);
  }
  then(whole.ok() ? std::optional(row) : std::nullopt);
}

Flow DurableJobs::DropResult(ResultRow row, std::function<void()> then) {
  bool dropped = false;
  const absl::Status status = co_await Commit(
      [&](JobStore& store) -> absl::Status {
        BCCSKEL_ASSIGN_OR_RETURN(const auto now, store.FindResult(row.number));
        dropped = now.has_value() && now->file == row.file;
        if (!dropped) return absl::OkStatus();  // dropped by another flow
        BCCSKEL_RETURN_IF_ERROR(store.DropResult(row));
        return store.Put(RemovalRow{RemovalRow::Kind::kResult, row.tenant, row.file});
      },
      GroupCommit::Room::kReserve);
  if (status.ok() && dropped) {
    options_.on_warning("a stored result is damaged; the next equal job recomputes it");
    RemoveResult(row, blobs_, quota_);
  }
  then();
}

void DurableJobs::GiveStoredResult(Run* run, int64_t result) {
  ActiveRun* const found = active_.FindOpen(run);
  if (found == nullptr) return;
  const std::set<int64_t> jobs = found->jobs;
  cached_ += jobs.size();
  found->ending = true;
  found->run->Cancel();
  active_.ForgetRun(run);
  EnterState(jobs, JobState::kSucceeded, absl::OkStatus(), result);
}

// Of two runs of the same volume in different encodings, the later one ends.
void DurableJobs::JoinEqual(Run* run) {
  const ActiveRun* const found = active_.FindOpen(run);
  ActiveRun* const other = found == nullptr ? nullptr : active_.FindEqual(*found);
  if (other == nullptr) return;
  const std::set<int64_t> jobs = found->jobs;
  found->run->Cancel();
  active_.ForgetRun(run);
  for (const int64_t job : jobs) active_.Attach(*other, job);
  Schedule();
}

// Assigns sequence numbers within a change, so that stored and unstored events come in one order.
Flow DurableJobs::OnRunProgress(std::shared_ptr<Run> run) {
  std::map<int64_t, JobEvent> events;
  const absl::Status stored = co_await Commit([&](JobStore& store) {
    if (events.empty()) events = TakeProgress(*run);
    return StoreProgress(store, events);
  });
  stored.IgnoreError();
  for (const auto& [job, event] : events) {
    if (active_.Find(job) != nullptr) watches_.Tell(job, event);
  }
}

// Publishes progress to the fleet's other servers, a few times per second.
absl::Status DurableJobs::StoreProgress(JobStore& store,
                                        const std::map<int64_t, JobEvent>& events) {
  constexpr std::chrono::milliseconds kBetween(200);
  const auto now = std::chrono::steady_clock::now();
  if (!shared_ || events.empty() || now - last_progress_ < kBetween) return absl::OkStatus();
  last_progress_ = now;
  for (const auto& [job, event] : events) {
    const std::string bytes = BytesOf(std::get<JobProgress>(event.what));
    BCCSKEL_RETURN_IF_ERROR(store.PutProgress(job, {.sequence = event.sequence, .bytes = bytes}));
  }
  return absl::OkStatus();
}

std::map<int64_t, JobEvent> DurableJobs::TakeProgress(Run& run) {
  std::map<int64_t, JobEvent> events;
  const std::optional<JobProgress> progress = run.TakeProgress();
  const ActiveRun* const found = active_.FindRun(&run);
  if (!progress.has_value() || found == nullptr) return events;
  for (const int64_t job : found->jobs) {
    const JobRow& row = active_.Find(job)->row;
    if (row.state != JobState::kRunning) continue;
    events.insert_or_assign(job, JobEvent{.sequence = journal_.NextSequence(job, row.sequence),
                                          .time = Now(),
                                          .what = *progress});
  }
  return events;
}

Flow DurableJobs::OnRunEnd(std::shared_ptr<Run> run, absl::StatusOr<JobResult> result) {
  absl::StatusOr<ResultRow> row;
  if (result.ok()) {
    loop_.Post([this, run] {
      if (ActiveRun* const computed = active_.FindRun(run.get())) active_.Computed(*computed);
      Schedule();
    });
    co_await ToFiles(run->tenant());
    row = WriteResult(*result, *run, codec_, blobs_, quota_);
    if (!row.ok()) row = WithDiskReason(row.status());
  } else {
    row = result.status();
  }
  result = absl::CancelledError();  // releases its memory
  co_await ToLoop();
  if (absl::IsInvalidArgument(row.status())) {  // the stored bytes may be damaged
    const absl::Status whole =
        co_await Await<absl::Status>([&](auto resume) { CheckBlobOf(run, resume); });
    if (!whole.ok()) row = whole;
  }
  ActiveRun* const found = active_.FindOpen(run.get());
  if (found == nullptr) {
    if (row.ok()) RemoveResult(*row, blobs_, quota_);
    co_return;
  }
  found->ending = true;
  if (!row.ok()) co_return RunFailed(run.get(), row.status());
  StoreResult(run, *std::move(row));
}

Flow DurableJobs::CheckBlobOf(std::shared_ptr<Run> run, DoneStatus done) {
  const ActiveRun* const found = active_.FindOpen(run.get());
  if (found == nullptr || found->source == ActiveRun::Source::kUpload) co_return done({});
  const auto volume = loop_.store().Find<VolumeRow>(run->tenant(), found->volume);
  if (!volume.ok() || !volume->has_value()) co_return done(volume.status());
  co_await ToFiles(run->tenant());
  auto file = CheckedFile::Open(blobs_.PathOf(**volume), (*volume)->blob_digest);
  const absl::Status whole = file.ok() ? file->ReadRest() : file.status();
  co_await ToLoop();
  done(whole);
}

Flow DurableJobs::StoreResult(std::shared_ptr<Run> run, ResultRow row) {
  std::vector<Step> steps;
  bool needless = false;
  const auto change = [&](JobStore& store) -> absl::Status {
    BCCSKEL_ASSIGN_OR_RETURN(needless, StoreResultOf(store, run.get(), row, steps));
    return absl::OkStatus();
  };
  while (!(co_await Commit(change, GroupCommit::Room::kReserve)).ok()) {
    if (co_await Later()) continue;
    if (!stopping_) RemoveResult(row, blobs_, quota_);  // others have taken over the job
    co_return;
  }
  if (needless) {
    RemoveResult(row, blobs_, quota_);
  } else {
    blobs_.ConfirmResult(row.tenant, row.file).IgnoreError();  // else the next start does
  }
  for (const Step& step : steps) Apply(step);
  active_.ForgetRun(run.get());
  Schedule();
}

absl::StatusOr<bool> DurableJobs::StoreResultOf(JobStore& store, const Run* run, ResultRow row,
                                                std::vector<Step>& steps) {
  steps.clear();
  const ActiveRun* const active = active_.FindRun(run);
  if (active == nullptr) return true;  // taken over by another server
  row.key = ResultKey(active->volume_digest, active->options);
  BCCSKEL_ASSIGN_OR_RETURN(const ResultRow kept, store.InsertResult(row));
  for (const int64_t job : active->jobs) {
    BCCSKEL_RETURN_IF_ERROR(
        StoreState(store, job, JobState::kSucceeded, absl::OkStatus(), kept.number, steps));
  }
  const bool equal_was_there = kept.file != row.file;
  if (!steps.empty()) return equal_was_there;
  BCCSKEL_ASSIGN_OR_RETURN(const auto unused, store.TakeResultIfUnused(kept.number));
  return equal_was_there || unused.has_value();
}

void DurableJobs::RunFailed(Run* run, const absl::Status& error) {
  const std::set<int64_t> jobs = active_.FindRun(run)->jobs;
  const bool received = !active_.FindRun(run)->volume.empty();
  active_.ForgetRun(run);
  if (!received) {
    for (const int64_t job : jobs) ReceivingFailed(job, error);
    return Schedule();
  }
  // The runner is stopping or has no room at the moment.
  const bool again = absl::IsUnavailable(error) || absl::IsCancelled(error);
  if (!jobs.empty()) {
    EnterState(jobs, again ? JobState::kQueued : JobState::kFailed,
               absl::IsCancelled(error) ? absl::OkStatus() : error);
  }
  if (!again || jobs.empty()) return Schedule();
  retry_wanted_ = true;
}

// The upload continues without decoding unless it is malformed.
void DurableJobs::ReceivingFailed(int64_t job, const absl::Status& error) {
  const JobRow& row = active_.Find(job)->row;
  if (const Session session = uploads_.Find(row.tenant, row.upload); session != nullptr) {
    session->DetachDecoder();
  }
  if (!absl::IsInvalidArgument(error)) return;
  EndUpload(row.tenant, row.upload, JobState::kFailed, error);
}

}  // namespace bccskel::server
