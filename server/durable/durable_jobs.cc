#include "server/durable/durable_jobs.h"

#include <algorithm>
#include <future>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/digest/random_id.h"
#include "core/exec/status_macros.h"
#include "server/admission/memory_estimate.h"
#include "server/errors/call_error.h"
#include "server/store/job_store.h"

namespace bccskel::server {
namespace {

// They mostly wait for the disk. One tenant may occupy all but one.
constexpr int kFileThreads = 4;
constexpr std::chrono::milliseconds kTick(100);

absl::StatusOr<std::unique_ptr<JobStore>> OpenOwn(const DurableOptions& options) {
  const std::string tables = options.data_directory + "/jobs.db";
  BCCSKEL_RETURN_IF_ERROR(FolderFiles::CheckTables(tables, options));
  return OpenSqliteJobStore(tables);
}

// When the previous server was last alive.
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
  // A shared store is on another disk.
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
      blobs_(options.data_directory),
      quota_(options.max_disk_bytes, options.max_tenant_disk_bytes),
      folder_(options_, std::move(lock)),
      journal_(RandomId(), [this] { return Now(); }),
      active_(shared_, options.soon),
      members_(options.lease),
      clock_(options.max_clock_leap, LastSeen(options.data_directory),
             std::chrono::steady_clock::now()),
      loop_(std::move(store), std::move(reserve)),
      files_(kFileThreads) {
  // Learns of the claims of other servers before claiming jobs here.
  loop_.OnBegin([this] {
    if (scheduling_) Sync();
  });
}

DurableJobs::~DurableJobs() {
  admitting_ = false;
  ticker_.request_stop();
  if (ticker_.joinable()) ticker_.join();
  std::promise<void> stopped;
  loop_.Post([this, &stopped] {
    stopping_ = true;
    Retry(false);
    active_.CancelRuns();
    stopped.set_value();
  });
  stopped.get_future().wait();
  operations_.WaitForAll();
  loop_.Post([this] {
    if (shared_) loop_.store().Leave().IgnoreError();
    watches_.EndAll(absl::UnavailableError("the server is stopping"));
  });
}

void DurableJobs::Retry(bool again) {
  for (const auto& go_on : std::exchange(retries_, {})) go_on(again);
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
  if (shared_) {
    BCCSKEL_RETURN_IF_ERROR(folder_.Join(store));
    BCCSKEL_RETURN_IF_ERROR(CountFiles(store));
    return store.Join(journal_.owner());
  }
  BCCSKEL_RETURN_IF_ERROR(CountFiles(store));
  BCCSKEL_RETURN_IF_ERROR(folder_.TakeOver(store));
  BCCSKEL_RETURN_IF_ERROR(folder_.RemoveDeleted(store));
  BCCSKEL_RETURN_IF_ERROR(RecoverUploads(store));
  return RecoverJobs(store);
}

absl::Status DurableJobs::RecoverUploads(JobStore& store) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<UploadRow> uploads, store.All<UploadRow>());
  for (const UploadRow& row : uploads) {
    if (!row.volume.empty()) continue;
    BCCSKEL_ASSIGN_OR_RETURN(std::unique_ptr<UploadFile> file,
                             UploadFile::Open(blobs_.PathOf(row)));
    // Now, because nobody could send while no server was running.
    uploads_.Add(std::make_shared<UploadSession>(row, std::move(file), Now()));
  }
  return absl::OkStatus();
}

absl::Status DurableJobs::RecoverJobs(JobStore& store) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<JobRow> jobs, store.UnfinishedJobs());
  for (const JobRow& job : jobs) {
    BCCSKEL_ASSIGN_OR_RETURN(const Step step, RecoverJob(store, job));
    Apply(step);
  }
  return absl::OkStatus();
}

absl::StatusOr<Step> DurableJobs::RecoverJob(JobStore& store, const JobRow& job) {
  if (job.state == JobState::kRunning) return journal_.RecoverRunning(store, job);
  if (job.state != JobState::kReceiving || uploads_.Find(job.tenant, job.upload) != nullptr) {
    return Step{job};
  }
  return journal_.Enter(store, job, JobState::kFailed, absl::DataLossError("its upload is gone"));
}

// Also true after a clock that was ahead has been corrected.
bool DurableJobs::CleanUpIsDue() const {
  const Time now = Now(), next = next_clean_up_;
  return now >= next || next - now > options_.clean_up_interval;
}

void DurableJobs::Tick(std::stop_token stop) {
  std::unique_lock lock(tick_mutex_);
  while (!stop.stop_requested()) {
    tick_.wait_for(lock, stop, kTick, [] { return false; });
    if (!retry_wanted_.exchange(false) && !CleanUpIsDue() && !shared_) continue;
    loop_.Post([this] {
      if (shared_ && !stopping_) MaintainFleet();
      Retry(true);
      if (CleanUpIsDue()) CleanUp();
      Schedule();
    });
  }
}

JobRequest DurableJobs::RunnerRequest(JobRequest request, const JobRow& job) {
  request.origin = {.tenant = job.tenant, .priority = PriorityOf(job)};
  request.threads_wanted = job.threads;
  // A job that has run into the memory of others begins again once its need of then is free.
  // Otherwise it would compete with them, and give up its work, again and again.
  request.min_bytes = NeededBytesOf(job.error).value_or(0);
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

absl::Status DurableJobs::CheckRoomForJob(const std::string& tenant) const {
  const TenantTable tenants = options_.tenants();
  const int all = static_cast<int>(active_.size()), own = active_.CountOf(tenant);
  if (all >= options_.max_unfinished_jobs) {
    return CallError(Reason::kQueueFull, absl::StrCat("all ", options_.max_unfinished_jobs,
                                                      " places for jobs are taken"));
  }
  const int most = tenants.MostPlaces(tenant, options_.max_unfinished_jobs, all - own);
  if (own < most) return absl::OkStatus();
  return CallError(
      Reason::kQueueFull,
      absl::StrCat(own, " durable jobs are receiving, waiting or running, the limit ",
                   "for this tenant's jobs together is ", most,
                   tenants.Shares(tenant) ? ", half of what other tenants leave" : ""));
}

void DurableJobs::Apply(const Step& step) {
  const JobRow& row = step.job;
  if (IsTerminal(row.state)) {
    active_.Forget(row.number);
    journal_.Forget(row.number);
  } else {
    ActiveJob& job = active_.Put(row);
    const bool waits = row.state == JobState::kQueued;
    const bool runs_elsewhere = row.state == JobState::kRunning && row.owner != journal_.owner();
    if (waits || runs_elsewhere) active_.Detach(row.number);
    if (waits) active_.Enqueue(job);
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
  for (const ResultRow& row : erased.results) RemoveResult(row, blobs_, quota_);
  // Other servers may store the same bytes at any time outside a transaction; in a fleet
  // RemoveDeleted() therefore deletes these files.
  std::set<std::pair<std::string, std::string>> removed;  // several volumes may have the same bytes
  for (const VolumeRow& row : shared_ ? std::vector<VolumeRow>() : erased.blobs) {
    // The same bytes may have been stored again in the meantime.
    const auto others = loop_.store().FindVolumesOf(row.tenant, row.blob_digest);
    if (!others.ok() || std::ranges::any_of(*others, [&](const VolumeRow& other) {
          return other.blob_digest == row.blob_digest;
        })) {
      continue;
    }
    if (!removed.emplace(row.tenant, row.blob_digest).second) continue;
    RemoveFile(blobs_.PathOfBlob(row.tenant, row.blob_digest)).IgnoreError();
    quota_.GiveBack(row.tenant, row.size_bytes);
  }
  if (erased.traces == Erased::Traces::kMayStay) return;
  // Also erases the removals, because names may be sensitive. If this fails, CleanUp() repeats it.
  JobStore& store = loop_.store();
  if (store.Begin().ok() && (!folder_.RemoveDeleted(store).ok() || !store.Commit().ok()))
    store.Rollback();
  store.Forget().IgnoreError();
}

Flow DurableJobs::Erase(std::function<absl::Status(JobStore& store, Erased& erased)> change,
                        DoneStatus done) {
  Erased erased;
  const auto erase = [&](JobStore& store) {
    erased = {};
    return change(store, erased);
  };
  absl::Status status = co_await Commit(erase, GroupCommit::Room::kReserve);
  if (status.ok()) Apply(erased);
  if (done) done(std::move(status));
  Schedule();
}

void DurableJobs::Probe() {
  loop_.Post([](JobStore&) { return absl::OkStatus(); }, [](const absl::Status&) {});
}

DurableUsage DurableJobs::usage() const {
  return {.healthy = Health().ok(),
          .disk_bytes = quota_.used(),
          .disk_available_bytes = std::min(quota_.available(), SpaceOf(options_.data_directory)),
          .uploads = static_cast<int>(uploads_.size()),
          .queued = active_.Count(JobState::kQueued),
          .running = active_.Count(JobState::kRunning),
          .cached = cached_};
}

}  // namespace bccskel::server
