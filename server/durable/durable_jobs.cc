#include "server/durable/durable_jobs.h"

#include <algorithm>
#include <future>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/admission/memory_estimate.h"
#include "server/errors/call_error.h"
#include "server/jobs/random_name.h"
#include "server/store/job_store.h"

namespace bccskel::server {
namespace {

// Most of their time they wait for the disk. One tenant may have all but one.
constexpr int kFileThreads = 4;
constexpr std::chrono::milliseconds kTick(100);

absl::Status UnknownData(const std::string& folder, size_t files) {
  return absl::FailedPreconditionError(absl::StrCat(
      folder, " holds ", files, " files of uploads, volumes and results that its jobs.db does not ",
      "know: that is missing, empty or from elsewhere. Nothing was changed. Bring back the "
      "jobs.db ",
      "that belongs to them, or start once with --unknown-data adopt to go on without it: files ",
      "that no table names are then removed at the first start after a day"));
}

// Before an empty one would be made.
absl::Status CheckTables(const std::string& tables, const DurableOptions& options) {
  const auto facts = FactsOf(tables);
  if ((facts.ok() && facts->size_bytes > 0) || options.unknown_data == "adopt") {
    return absl::OkStatus();
  }
  BCCSKEL_ASSIGN_OR_RETURN(const auto files, BlobStore(options.data_directory).Files());
  return files.empty() ? absl::OkStatus() : UnknownData(options.data_directory, files.size());
}

absl::StatusOr<std::unique_ptr<JobStore>> OpenOwn(const DurableOptions& options) {
  const std::string tables = options.data_directory + "/jobs.db";
  BCCSKEL_RETURN_IF_ERROR(CheckTables(tables, options));
  return OpenSqliteJobStore(tables);
}

// When the server before this one was there last.
std::optional<Time> LastSeen(const std::string& folder) {
  const auto facts = FactsOf(folder + "/lock");
  if (!facts.ok()) return std::nullopt;
  return facts->written;
}

}  // namespace

absl::StatusOr<std::unique_ptr<DurableJobs>> DurableJobs::Open(const DurableOptions& options,
                                                               JobRunner& runner,
                                                               const JobCodec& codec) {
  const bool shared = !options.job_store.empty();
  BCCSKEL_RETURN_IF_ERROR(MakeFolder(options.data_directory));
  BCCSKEL_ASSIGN_OR_RETURN(FolderLock lock, FolderLock::Take(options.data_directory,
                                                             shared ? FolderLock::With::kOthers
                                                                    : FolderLock::With::kNobody));
  BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<JobStore> store,
                           shared ? OpenPostgresJobStore(options.job_store) : OpenOwn(options));
  // What a shared store needs is on another disk.
  auto reserve =
      shared ? nullptr : std::make_unique<DiskReserve>(options.data_directory + "/reserve");
  auto durable_jobs = std::make_unique<DurableJobs>(options, runner, codec, std::move(lock),
                                                    std::move(store), std::move(reserve));
  BCCSKEL_RETURN_IF_ERROR(durable_jobs->Recover());
  return durable_jobs;
}

DurableJobs::DurableJobs(const DurableOptions& options, JobRunner& runner, const JobCodec& codec,
                         FolderLock lock, std::unique_ptr<JobStore> store,
                         std::unique_ptr<DiskReserve> reserve)
    : options_(options),
      runner_(runner),
      codec_(codec),
      shared_(store->shared()),
      lock_(std::move(lock)),
      blobs_(options.data_directory),
      quota_(options.max_disk_bytes, options.max_tenant_disk_bytes),
      journal_(RandomId(), [this] { return Now(); }),
      clock_(options.believable_leap, LastSeen(options.data_directory),
             std::chrono::steady_clock::now()),
      loop_(std::move(store), std::move(reserve)),
      files_(kFileThreads) {}

DurableJobs::~DurableJobs() {
  admitting_ = false;
  ticker_.request_stop();
  if (ticker_.joinable()) ticker_.join();
  OnLoop([this] {
    stopping_ = true;
    retries_.clear();
    for (const auto& [run, active] : runs_) run->Cancel();
  });
  operations_.WaitForAll();
  OnLoop([this] { loop_.store().Leave().IgnoreError(); });
  OnLoop([this] { watches_.EndAll(absl::UnavailableError("the server stops")); });
}

void DurableJobs::OnLoop(std::function<void()> task) {
  std::promise<void> done;
  loop_.Post([&] {
    task();
    done.set_value();
  });
  done.get_future().wait();
}

absl::Status DurableJobs::Recover() {
  std::promise<absl::Status> recovered;
  loop_.Post([this](JobStore& store) { return RecoverStore(store); },
             [this, &recovered](absl::Status status) {
               if (status.ok()) Sync();
               if (status.ok()) CleanUp();
               if (status.ok()) Schedule();
               recovered.set_value(std::move(status));
             },
             GroupCommit::Room::kReserve);
  absl::Status status = recovered.get_future().get();
  if (status.ok()) ticker_ = std::jthread([this](std::stop_token stop) { Tick(stop); });
  return status;
}

absl::Status DurableJobs::RecoverStore(JobStore& store) {
  if (shared_) return JoinFleet(store);
  BCCSKEL_RETURN_IF_ERROR(CountFiles(store));
  BCCSKEL_ASSIGN_OR_RETURN(const std::set<std::string> known, KnownFiles(store));
  BCCSKEL_ASSIGN_OR_RETURN(const std::set<std::string> files, blobs_.Files());
  BCCSKEL_RETURN_IF_ERROR(TakeOver(store, files, known));
  BCCSKEL_RETURN_IF_ERROR(RemoveFiles(store));
  BCCSKEL_RETURN_IF_ERROR(RecoverUploads(store));
  return RecoverJobs(store);
}

absl::StatusOr<std::set<std::string>> DurableJobs::KnownFiles(JobStore& store) {
  std::set<std::string> known;
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<UploadRow> uploads, store.AllUploads());
  for (const UploadRow& row : uploads) {
    if (row.volume.empty()) known.merge(blobs_.PathsOfUpload(row.tenant, row.name, row.file));
  }
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<VolumeRow> volumes, store.AllVolumes());
  for (const VolumeRow& row : volumes) known.insert(blobs_.PathOfBlob(row.tenant, row.blob_digest));
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<ResultRow> results, store.AllResults());
  for (const ResultRow& row : results) {
    if (row.file.empty()) continue;
    const std::string path = blobs_.PathOfResult(row.tenant, row.file);
    known.insert(path);
    if (shared_) known.insert(path + kUnconfirmed);
    // A crash may have come in between; what is lost shows when it is missed.
    if (!shared_) blobs_.ConfirmResult(row.tenant, row.file).IgnoreError();
  }
  return known;
}

// Files that another job store has named are not this one's to sweep. Folders of older servers do
// not say whose they are: then one file that is known is enough.
absl::Status DurableJobs::TakeOver(JobStore& store, const std::set<std::string>& files,
                                   const std::set<std::string>& known) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string id, store.Id());
  if (lock_.store_id() == id) {
    Sweep(store, files, known);
    return absl::OkStatus();
  }
  const auto is_known = [&known](const std::string& file) { return known.count(file) > 0; };
  const bool strange =
      !files.empty() && (!lock_.store_id().empty() || std::ranges::none_of(files, is_known));
  if (strange && options_.unknown_data != "adopt") {
    return UnknownData(options_.data_directory, files.size());
  }
  return lock_.SetStoreId(id);
}

// Only what is old and certainly not missed by anybody: while a file that is named is not there, or
// a row cannot be read, an unknown file may be that one.
void DurableJobs::Sweep(JobStore& store, const std::set<std::string>& files,
                        const std::set<std::string>& known) {
  const bool certain = store.damaged_rows() == 0 && std::ranges::includes(files, known);
  int kept = 0;
  for (const std::string& file : files) {
    if (known.count(file) > 0) continue;
    const auto facts = FactsOf(file);
    const bool old = file.ends_with(kUnconfirmed) ||
                     (facts.ok() && facts->written < Now() - options_.keep_unknown);
    if (!certain || !old || !RemoveFile(file).ok()) ++kept;
  }
  if (kept == 0) return;
  options_.on_warning(absl::StrCat(
      kept, " files below ", options_.data_directory, " are named by no table and were kept",
      certain ? "; they go when they are a day old"
              : ": files that are named are missing, or rows are damaged"));
}

absl::Status DurableJobs::RecoverUploads(JobStore& store) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<UploadRow> uploads, store.AllUploads());
  for (const UploadRow& row : uploads) {
    if (!row.volume.empty()) continue;
    BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<UploadFile> file,
                             blobs_.OpenUpload(row.tenant, row.name));
    // Nobody could send while there was no server.
    AddSession(std::make_shared<UploadSession>(row, std::move(file), Now()));
  }
  return absl::OkStatus();
}

absl::Status DurableJobs::RecoverJobs(JobStore& store) {
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<JobRow> jobs, store.UnfinishedJobs());
  for (JobRow& job : jobs) {
    BCCSKEL_ASSIGN_OR_RETURN(const auto event, RecoverJob(store, job));
    Apply(Step{.job = job, .event = event});
  }
  return absl::OkStatus();
}

absl::StatusOr<std::optional<EventRow>> DurableJobs::RecoverJob(JobStore& store, JobRow& job) {
  if (job.state == JobState::kRunning) return journal_.RecoverRunning(store, job);
  if (job.state != JobState::kReceiving || FindSession(job.tenant, job.upload) != nullptr) {
    return std::nullopt;
  }
  return journal_.Enter(store, job, JobState::kFailed, absl::DataLossError("its upload is gone"));
}

// Also where the clock was ahead at the last one and goes right again.
bool DurableJobs::CleanUpIsDue() const {
  const Time now = Now();
  return now >= next_clean_up_ || next_clean_up_ - now > options_.clean_up_interval;
}

void DurableJobs::Tick(std::stop_token stop) {
  std::unique_lock lock(tick_mutex_);
  while (!stop.stop_requested()) {
    tick_.wait_for(lock, stop, kTick, [] { return false; });
    if (!retry_wanted_.exchange(false) && !CleanUpIsDue() && !shared_) continue;
    loop_.Post([this] {
      if (shared_ && !stopping_) LookAfterFleet();
      for (const auto& task : std::exchange(retries_, {})) task();
      if (CleanUpIsDue()) CleanUp();
      Schedule();
    });
  }
}

JobPriority DurableJobs::PriorityOf(const JobRow& job) {
  if (job.priority == 0) return JobPriority::kNormal;
  return job.priority < 0 ? JobPriority::kLow : JobPriority::kHigh;
}

JobRequest DurableJobs::RunnerRequest(JobRequest request, const JobRow& job) {
  request.origin = {.tenant = job.tenant, .priority = PriorityOf(job)};
  request.threads_wanted = job.threads;
  return request;
}

absl::Status DurableJobs::CheckAdmitting() const {
  if (admitting_) return absl::OkStatus();
  return CallError(Reason::kDraining, "the server is about to stop");
}

absl::Status DurableJobs::CheckFits(const JobRequest& request) const {
  const uint64_t bytes = BytesToSkeletonize(request.header, request.size_bytes);
  if (options_.max_job_bytes == 0 || bytes <= options_.max_job_bytes) return absl::OkStatus();
  return CallError(Reason::kVolumeTooLarge,
                   absl::StrCat("the job needs ", bytes, " bytes of memory, the limit is ",
                                options_.max_job_bytes),
                   {.quota = "max_admitted_bytes"});
}

absl::Status DurableJobs::CheckRoomForJob() const {
  if (active_.size() < static_cast<size_t>(options_.max_unfinished_jobs)) return absl::OkStatus();
  return CallError(Reason::kQueueFull, absl::StrCat("all ", options_.max_unfinished_jobs,
                                                    " places for jobs are taken"));
}

void DurableJobs::Apply(const Step& step) {
  const JobRow& row = step.job;
  if (const auto found = active_.find(row.number); found != active_.end()) {
    --jobs_in_state_[static_cast<size_t>(found->second.row.state)];
    Dequeue(found->second);
  }
  if (IsTerminal(row.state)) {
    Detach(row.number);
    active_.erase(row.number);
    journal_.Forget(row.number);
  } else {
    active_[row.number].row = row;
    ++jobs_in_state_[static_cast<size_t>(row.state)];
    if (row.state == JobState::kQueued) {
      Detach(row.number);
      Enqueue(active_[row.number]);
    }
    const bool runs_elsewhere = row.state == JobState::kRunning && row.owner != journal_.owner();
    if (runs_elsewhere) Detach(row.number);
  }
  if (!step.event.has_value()) return;
  options_.on_job_state(row);
  watches_.Tell(row.number, EventOf(*step.event));
}

void DurableJobs::Apply(const Erased& erased) {
  for (const Step& step : erased.steps) Apply(step);
  for (const UploadRow& row : erased.uploads) {
    DropSession(row);
    quota_.GiveBack(row.tenant, row.size_bytes);
  }
  for (const ResultRow& row : erased.results) {
    if (!row.file.empty()) RemoveResult(row, blobs_, quota_);
  }
  // Others may store the same bytes again at any time, but for the time of a transaction: then the
  // files go with those that were to be removed.
  for (const VolumeRow& row : shared_ ? std::vector<VolumeRow>() : erased.blobs) {
    // The same bytes may have come again in the meantime.
    const auto others = loop_.store().FindVolumesOf(row.tenant, row.blob_digest);
    if (!others.ok() || std::ranges::any_of(*others, [&](const VolumeRow& other) {
          return other.blob_digest == row.blob_digest;
        })) {
      continue;
    }
    blobs_.RemoveBlob(row.tenant, row.blob_digest).IgnoreError();
    quota_.GiveBack(row.tenant, row.size_bytes);
  }
  if (erased.traces == Erased::Traces::kMayStay) return;
  // Also of what was to be removed: names tell something. Where it fails CleanUp() does it.
  JobStore& store = loop_.store();
  if (store.Begin().ok() && (!RemoveFiles(store).ok() || !store.Commit().ok())) store.Rollback();
  store.Forget().IgnoreError();
}

void DurableJobs::Erase(std::function<absl::Status(JobStore& store, Erased& erased)> change,
                        DoneStatus done) {
  const auto erased = std::make_shared<Erased>();
  loop_.Post(
      [change = std::move(change), erased](JobStore& store) -> absl::Status {
        *erased = {};
        BCCSKEL_RETURN_IF_ERROR(change(store, *erased));
        using Kind = RemovalRow::Kind;
        for (const UploadRow& row : erased->uploads) {
          BCCSKEL_RETURN_IF_ERROR(store.InsertRemoval(RemovalOf(row)));
        }
        for (const VolumeRow& row : erased->blobs) {
          BCCSKEL_RETURN_IF_ERROR(store.InsertRemoval({Kind::kBlob, row.tenant, row.blob_digest}));
        }
        for (const ResultRow& row : erased->results) {
          if (row.file.empty()) continue;
          BCCSKEL_RETURN_IF_ERROR(store.InsertRemoval({Kind::kResult, row.tenant, row.file}));
        }
        return absl::OkStatus();
      },
      [this, erased, done = std::move(done)](absl::Status status) {
        if (status.ok()) Apply(*erased);
        done(std::move(status));
        Schedule();
      },
      GroupCommit::Room::kReserve);
}

DurableUsage DurableJobs::usage() const {
  std::lock_guard lock(sessions_mutex_);
  const auto count = [this](JobState state) {
    return jobs_in_state_[static_cast<size_t>(state)].load();
  };
  return {.disk_bytes = quota_.used(),
          .disk_available_bytes = std::min(quota_.available(), SpaceOf(options_.data_directory)),
          .uploads = static_cast<int>(sessions_.size()),
          .queued = count(JobState::kQueued),
          .running = count(JobState::kRunning),
          .commits = loop_.commits(),
          .cached = cached_};
}

}  // namespace bccskel::server
