#include <utility>

#include "core/exec/status_macros.h"
#include "server/durable/durable_jobs.h"
#include "server/errors/call_error.h"

namespace bccskel::server {

// A result on its way into the store.
struct DurableJobs::Storing {
  std::shared_ptr<Run> run;
  ResultRow row;
  std::vector<Step> steps;
  bool needless = false;  // nobody wants it, or an equal one was there
};

void DurableJobs::OnRunVolume(std::shared_ptr<Run> run, std::string volume_digest) {
  loop_.Post([this, run = std::move(run), digest = std::move(volume_digest)] {
    VolumeKnown(run, digest);
  });
}

// The run is held: another one at its address would be given its result.
void DurableJobs::VolumeKnown(const std::shared_ptr<Run>& run, const std::string& digest) {
  ActiveRun* const found = active_.FindOpen(run.get());
  if (found == nullptr) return;
  ActiveRun& active = *found;
  if (active.volume_digest == digest) return;  // it was looked for already
  active.volume_digest = digest;
  const std::string key = ResultKey(digest, active.options);
  loop_.Post(
      [tenant = active.tenant, volume = active.volume, digest](JobStore& store) -> absl::Status {
        BCCSKEL_ASSIGN_OR_RETURN(std::optional<VolumeRow> row,
                                 store.Find<VolumeRow>(tenant, volume));
        if (row.has_value() && row->volume_digest != digest) {
          row->volume_digest = digest;
          BCCSKEL_RETURN_IF_ERROR(store.PutVolume(*row));
        }
        return absl::OkStatus();
      },
      [this, run, tenant = active.tenant, key](const absl::Status&) {
        WithWholeResult(tenant, key, [this, run](const std::optional<ResultRow>& result) {
          if (result.has_value()) return GiveStoredResult(run.get(), result->number);
          JoinEqual(run.get());
        });
      });
}

void DurableJobs::WithWholeResult(
    const std::string& tenant, const std::string& key,
    std::function<void(const std::optional<ResultRow>& result)> then) {
  const auto stored = loop_.store().FindResultOf(tenant, key);
  if (!stored.ok() || !stored->has_value()) return then(std::nullopt);
  files_.Post({.tenant = tenant}, [this, row = **stored, then = std::move(then),
                                   token = operations_.Begin()]() mutable {
    const absl::Status whole = blobs_.OpenResult(row.tenant, row.file, row.file_digest).status();
    if (whole.ok()) return loop_.Post([row, then = std::move(then), token] { then(row); });
    if (absl::IsUnavailable(whole)) {  // it cannot be read just now
      return loop_.Post([then = std::move(then), token] { then(std::nullopt); });
    }
    DropResult(row, [then = std::move(then), token] { then(std::nullopt); });
  });
}

void DurableJobs::DropResult(const ResultRow& row, std::function<void()> then) {
  const auto dropped = std::make_shared<bool>(false);
  loop_.Post(
      [row, dropped](JobStore& store) -> absl::Status {
        BCCSKEL_ASSIGN_OR_RETURN(const auto now, store.FindResult(row.number));
        *dropped = now.has_value() && now->file == row.file;
        if (!*dropped) return absl::OkStatus();  // somebody else was here first
        BCCSKEL_RETURN_IF_ERROR(store.DropResult(row));
        return store.InsertRemoval({RemovalRow::Kind::kResult, row.tenant, row.file});
      },
      [this, row, dropped, then = std::move(then)](const absl::Status& status) {
        if (status.ok() && *dropped) {
          options_.on_warning("a stored result is damaged; the next equal job recomputes it");
          RemoveResult(row, blobs_, quota_);
        }
        then();
      },
      GroupCommit::Room::kReserve);
}

void DurableJobs::GiveStoredResult(Run* run, int64_t result) {
  ActiveRun* const found = active_.FindOpen(run);
  if (found == nullptr) return;
  const std::set<int64_t> jobs = found->jobs;
  cached_ += jobs.size();
  found->ending = true;
  found->run->Cancel();
  active_.ForgetRun(run);
  EnterState(jobs, JobState::kSucceeded, absl::OkStatus(), result, nullptr);
}

// The later of two runs of the same volume, encoded differently, gives way.
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

// Numbers are given within a change: what is stored and what is only told come in one order.
void DurableJobs::OnRunProgress(std::shared_ptr<Run> run) {
  const auto events = std::make_shared<std::map<int64_t, JobEvent>>();
  loop_.Post(
      [this, run = std::move(run), events](JobStore& store) {
        if (events->empty()) *events = TakeProgress(*run);
        return StoreProgress(store, *events);
      },
      [this, events](const absl::Status&) {
        for (const auto& [job, event] : *events) {
          if (active_.Find(job) != nullptr) watches_.Tell(job, event);
        }
      });
}

// For the fleet's other servers, a few times a second.
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

void DurableJobs::OnRunEnd(std::shared_ptr<Run> run, absl::StatusOr<JobResult> result) {
  if (!result.ok()) {
    return loop_.Post([this, run = std::move(run), error = std::move(result).status()] {
      RunEnded(run.get(), error);
    });
  }
  const auto held = std::make_shared<std::optional<JobResult>>(*std::move(result));
  loop_.Post([this, run] { RunComputed(run.get()); });
  files_.Post({.tenant = run->tenant()}, [this, run, held] {
    absl::StatusOr<ResultRow> row = WriteResult(**held, *run, codec_, blobs_, quota_);
    held->reset();  // its memory is admitted until here
    if (!row.ok()) row = WithDiskReason(row.status());
    loop_.Post([this, run, row = std::move(row)] { RunEnded(run.get(), row); });
  });
}

void DurableJobs::RunComputed(Run* run) {
  ActiveRun* const found = active_.FindRun(run);
  if (found == nullptr) return;
  active_.Computed(*found);
  Schedule();
}

void DurableJobs::RunEnded(Run* run, const absl::StatusOr<ResultRow>& result) {
  ActiveRun* const found = active_.FindOpen(run);
  if (found == nullptr) {
    if (result.ok()) RemoveResult(*result, blobs_, quota_);
    return;
  }
  found->ending = true;
  if (!result.ok()) return RunFailed(run, result.status());
  StoreResult(run, *result);
}

void DurableJobs::StoreResult(Run* run, const ResultRow& row) {
  const auto storing = std::make_shared<Storing>();
  storing->run = active_.FindRun(run)->run;
  storing->row = row;
  loop_.Post(
      [this, storing](JobStore& store) { return StoreResultOf(store, *storing); },
      [this, storing, row](const absl::Status& status) {
        if (!status.ok()) {
          return RetryLater([this, run = storing->run, row] { StoreResult(run.get(), row); });
        }
        if (storing->needless) {
          RemoveResult(row, blobs_, quota_);
        } else {
          blobs_.ConfirmResult(row.tenant, row.file).IgnoreError();  // else at the next start
        }
        for (const Step& step : storing->steps) Apply(step);
        active_.ForgetRun(storing->run.get());
        Schedule();
      },
      GroupCommit::Room::kReserve);
}

absl::Status DurableJobs::StoreResultOf(JobStore& store, Storing& storing) {
  storing.steps.clear();
  const ActiveRun* const found = active_.FindRun(storing.run.get());
  storing.needless = found == nullptr;  // it was taken over by others
  if (storing.needless) return absl::OkStatus();
  const ActiveRun& active = *found;
  storing.row.key = ResultKey(active.volume_digest, active.options);
  BCCSKEL_ASSIGN_OR_RETURN(const ResultRow kept, store.InsertResult(storing.row));
  for (const int64_t job : active.jobs) {
    BCCSKEL_RETURN_IF_ERROR(
        EnterState(store, job, JobState::kSucceeded, absl::OkStatus(), kept.number, storing.steps));
  }
  storing.needless = kept.file != storing.row.file;
  if (!storing.steps.empty()) return absl::OkStatus();
  BCCSKEL_ASSIGN_OR_RETURN(const auto unused, store.TakeResultIfUnused(kept.number));
  storing.needless = storing.needless || unused.has_value();
  return absl::OkStatus();
}

void DurableJobs::RunFailed(Run* run, const absl::Status& error) {
  const std::set<int64_t> jobs = active_.FindRun(run)->jobs;
  const bool received = !active_.FindRun(run)->volume.empty();
  active_.ForgetRun(run);
  if (!received) {
    for (const int64_t job : jobs) ReceivingFailed(job, error);
    return Schedule();
  }
  // The runner stops, or has no room just now.
  const bool again = absl::IsUnavailable(error) || absl::IsCancelled(error);
  if (!jobs.empty()) {
    EnterState(jobs, again ? JobState::kQueued : JobState::kFailed,
               again ? absl::OkStatus() : error, 0, nullptr);
  }
  if (!again || jobs.empty()) return Schedule();
  retry_wanted_ = true;
}

// The upload can go on without being decoded, unless it is malformed.
void DurableJobs::ReceivingFailed(int64_t job, const absl::Status& error) {
  const JobRow& row = active_.Find(job)->row;
  if (const Session session = uploads_.Find(row.tenant, row.upload); session != nullptr) {
    session->TakeAlong();
  }
  if (!absl::IsInvalidArgument(error)) return;
  EndUpload(row.tenant, row.upload, JobState::kFailed, error,
            [token = operations_.Begin()](const absl::Status&) {});
}

}  // namespace bccskel::server
