#ifndef BCCSKEL_SERVER_DURABLE_DURABLE_JOBS_H_
#define BCCSKEL_SERVER_DURABLE_DURABLE_JOBS_H_

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "server/durable/active_jobs.h"
#include "server/durable/clock_guard.h"
#include "server/durable/durable_options.h"
#include "server/durable/fleet_members.h"
#include "server/durable/flow.h"
#include "server/durable/folder_files.h"
#include "server/durable/job_codec.h"
#include "server/durable/job_journal.h"
#include "server/durable/records.h"
#include "server/durable/run.h"
#include "server/durable/stored_result.h"
#include "server/durable/upload_table.h"
#include "server/durable/watch_board.h"
#include "server/jobs/task_threads.h"
#include "server/store/blob_store.h"
#include "server/store/data_folder.h"
#include "server/store/disk_quota.h"
#include "server/store/group_commit.h"

namespace bccskel::server {

// Uploads, volumes, jobs and results that survive the process: what a callback has confirmed with
// OK is on disk. Every function returns at once; `done` is called exactly once, on a thread of
// DurableJobs, and must not block. Names are looked up within the tenant: those of others are
// NOT_FOUND.
// Errors of all functions: NOT_FOUND for names; RESOURCE_EXHAUSTED when the disk is full;
//                          UNAVAILABLE when the server is draining; INTERNAL.
// Threads: safe.
//
// State in memory, except for uploads, belongs to the loop: the thread of the job store. An
// operation is a flow (flow.h). Only changes (Commit()) write the store. A flow waits for its
// changes and resumes on the loop once they are on disk; only there it updates the state in memory.
// Flows move to other threads to read and write files.
//
// Its parts: UploadTable and ActiveJobs hold what is unfinished, JobJournal changes states,
// WatchBoard distributes events, FolderFiles keeps files and tables consistent, FleetMembers
// detects lost servers. durable_jobs.cc opens and closes; uploads.cc, volumes.cc and jobs.cc answer
// callers; runs.cc and results.cc compute; expiry.cc cleans up.
//
// Several processes may share the store and the folder. Each then holds the unfinished jobs of all,
// as of a moment ago; changes read the current state from the store. fleet.cc follows the others'
// changes and takes over from lost servers.
class DurableJobs final : public RunObserver {
 public:
  template <typename Value>
  using Done = std::function<void(absl::StatusOr<Value>)>;
  using DoneStatus = std::function<void(absl::Status)>;

  // Opens the data directory, completes what a crash interrupted and continues unfinished jobs.
  // Needs: `runner` and `codec` outlive DurableJobs. Blocks; may take as long as reading all
  // unfinished uploads.
  // Errors: ALREADY_EXISTS when another process owns the directory; FAILED_PRECONDITION for a
  //         directory of a newer version, and for files of another job store; RESOURCE_EXHAUSTED;
  //         DATA_LOSS for a damaged job store.
  static absl::StatusOr<std::unique_ptr<DurableJobs>> Open(const DurableOptions& options,
                                                           JobRunner& runner,
                                                           const JobCodec& codec);
  // Stops: running jobs return to the queue without losing an attempt; watches end. Waits for
  // operations in progress. Needs: no further calls, and no readers.
  ~DurableJobs() override;

  // Refuses new uploads and jobs as kDraining, and starts no further job.
  void StopAdmitting() { admitting_ = false; }

  // ---- Uploads. Chunks have at most 1 MiB.

  // Errors: INVALID_ARGUMENT; ALREADY_EXISTS for a name in use by a different upload;
  //         RESOURCE_EXHAUSTED for a quota; with a job, the runner's.
  Flow CreateUpload(std::string tenant, NewUpload upload, Done<UploadInfo> done);
  // Yields the committed size, when there is room for more. Checks `bytes` against `crc32c` if
  // given.
  // Errors: OUT_OF_RANGE with the detail "committed_size" for a wrong offset and for more bytes
  //         than declared; ABORTED during another Append() or FinishUpload(); INVALID_ARGUMENT for
  //         a wrong checksum, or for a volume found malformed during the upload;
  //         FAILED_PRECONDITION after the upload was finished.
  Flow Append(std::string tenant, std::string upload, uint64_t offset, std::string bytes,
              std::optional<uint32_t> crc32c, Done<uint64_t> done);
  // The sender is gone for now: drops what was decoded so far and releases its memory. The upload
  // stays and can be resumed.
  void SenderGone(const std::string& tenant, const std::string& upload);
  Flow GetUpload(std::string tenant, std::string upload, Done<UploadInfo> done);
  // Turns the upload into a volume and queues the job that waits for it. Finishing again yields the
  // same volume.
  // Errors: OUT_OF_RANGE with the committed size while bytes are missing; INVALID_ARGUMENT if size
  //         or digest do not match the bytes (the upload is then deleted); ABORTED.
  Flow FinishUpload(std::string tenant, std::string upload, uint64_t size_bytes,
                    std::optional<Sha256Digest> sha256, Done<VolumeInfo> done);
  // Also cancels the job that waits for it.
  void DeleteUpload(const std::string& tenant, const std::string& upload, DoneStatus done);

  // ---- Volumes

  // The tenant's volumes with these blob or volume digests (64 hexadecimal digits). The same bytes
  // may be several volumes with different declarations.
  Flow FindVolumes(std::string tenant, std::vector<std::string> digests,
                   Done<std::vector<VolumeInfo>> done);
  // Erases the bytes. Errors: FAILED_PRECONDITION while an unfinished job needs the volume.
  void DeleteVolume(const std::string& tenant, const std::string& volume, DoneStatus done);

  // ---- Jobs

  // With kValidateOnly yields the job that would be created, without a name.
  // Errors: FAILED_PRECONDITION when there is no such volume; ALREADY_EXISTS for a request_id of a
  //         different request; INVALID_ARGUMENT; RESOURCE_EXHAUSTED for a volume that can never be
  //         admitted; kQueueFull.
  Flow CreateJob(std::string tenant, NewJob job, Done<JobInfo> done);
  Flow GetJob(std::string tenant, std::string job, Done<JobInfo> done);
  // Errors: INVALID_ARGUMENT for a page token of a query with other states.
  Flow ListJobs(std::string tenant, JobQuery query, Done<JobPage> done);
  // Yields the job as it is afterwards: cancelled, unless it had ended before.
  Flow CancelJob(std::string tenant, std::string job, Done<JobInfo> done);
  // Erases the job, its unfinished upload, and its result unless another job shares it. Cancels the
  // job first if it has not ended.
  void DeleteJob(const std::string& tenant, const std::string& job, DoneStatus done);
  // Watches events after `after_sequence` (0: all), and always the last one, until the watch is
  // stopped.
  std::shared_ptr<Watch> WatchJob(const std::string& tenant, const std::string& job,
                                  uint64_t after_sequence, std::shared_ptr<JobWatcher> watcher);
  // Errors: FAILED_PRECONDITION for a job that has not succeeded; OUT_OF_RANGE for a first record
  //         above the number of records (equal is allowed); DATA_LOSS for a damaged file.
  Flow OpenResult(std::string tenant, std::string job, uint64_t first_record,
                  Done<std::shared_ptr<ResultReader>> done);

  // ---- Metrics

  DurableUsage usage() const;
  // Not OK when confirmed data may be lost or read wrongly because the tables are damaged or
  // missing. OK on a full disk.
  absl::Status Health() const { return loop_.Health(); }
  // Tries the store, for Health() to learn soon whether it works again even if nobody calls.
  void Probe();

  // For Open(), which calls Recover() next, once.
  DurableJobs(const DurableOptions& options, JobRunner& runner, const JobCodec& codec,
              FolderLock lock, std::unique_ptr<JobStore> store,
              std::unique_ptr<DiskReserve> reserve);
  absl::Status Recover();

 private:
  using Session = UploadTable::Session;

  struct Opening;
  struct Finishing;
  struct Creating;
  struct Claiming;
  struct Claims;
  // What a change has deleted, for the steps after it.
  struct Erased {
    std::vector<Step> steps;
    std::vector<UploadRow> uploads;  // unfinished ones
    std::vector<ResultRow> results;
    std::vector<VolumeRow> blobs;  // whose bytes may be unused now
    enum class Traces { kMayStay, kErase } traces = Traces::kMayStay;  // in the store's files
  };

  // ---- Opening and closing
  absl::Status RecoverStore(JobStore& store);
  absl::Status RecoverUploads(JobStore& store);
  absl::Status RecoverJobs(JobStore& store);
  absl::StatusOr<Step> RecoverJob(JobStore& store, const JobRow& job);
  void Tick(std::stop_token stop);

  // ---- What flows wait for
  friend Flow::promise_type;
  Operations::Token BeginOperation() { return operations_.Begin(); }
  // Runs a change, possibly several times. The flow resumes after it, with its error.
  template <typename Change>
  auto Commit(Change change, GroupCommit::Room room = GroupCommit::Room::kFree) {
    return Await<absl::Status>(
        [this, change, room](auto resume) { loop_.Post(change, resume, room); });
  }
  // A change that yields a value.
  template <typename Value, typename Change>
  auto Read(Change change) {
    return Await<absl::StatusOr<Value>>([this, change](auto resume) {
      const auto value = std::make_shared<absl::StatusOr<Value>>();
      loop_.Post([change, value](JobStore& store) { return (*value = change(store)).status(); },
                 [value, resume](absl::Status status) {
                   if (!status.ok()) *value = std::move(status);
                   resume(std::move(*value));
                 });
    });
  }
  auto ToLoop() {
    return Await<std::monostate>([this](auto resume) { loop_.Post(resume); });
  }
  // The threads that read and write files.
  auto ToFiles(const std::string& tenant = {}) {
    return Await<std::monostate>(
        [this, &tenant](auto resume) { files_.Post({.tenant = tenant}, resume); });
  }
  // Resumes soon to try again; yields false when stopping.
  auto Later() {
    return Await<bool>([this](auto resume) {
      if (stopping_) return resume(false);
      retries_.push_back(resume);
      retry_wanted_ = true;
    });
  }
  void Retry(bool again);
  auto SessionOf(const std::string& tenant, const std::string& upload) {
    return Await<absl::StatusOr<Session>>(
        [this, &tenant, &upload](auto resume) { OpenSession(tenant, upload, resume); });
  }
  // Finds the stored result and reads it to its end; drops a damaged one and yields nullopt. On the
  // loop.
  auto WholeResult(const std::string& tenant, const std::string& key) {
    return Await<std::optional<ResultRow>>(
        [this, &tenant, &key](auto resume) { ReadResult(tenant, key, resume); });
  }
  auto Dropped(const ResultRow& row) {
    return Await<std::monostate>([this, &row](auto resume) { DropResult(row, resume); });
  }

  // The request as the runner takes it.
  static JobRequest RunnerRequest(JobRequest request, const JobRow& job);
  absl::Status CheckAdmitting() const;
  absl::Status CheckFits(const JobRequest& request) const;
  absl::Status CheckRoomForJob(const std::string& tenant) const;
  // With the precision of the store, so that times do not change when read back.
  Time Now() const { return std::chrono::floor<std::chrono::microseconds>(options_.now()); }

  // ---- Uploads
  // The session of an unfinished upload; takes over another server's.
  // Errors: NOT_FOUND; FAILED_PRECONDITION for a finished upload; ABORTED while it is being opened.
  Flow OpenSession(std::string tenant, std::string upload, Done<Session> done);
  static absl::Status StoreMove(JobStore& store, const UploadRow& old, const std::string& to);
  // Another server has taken the upload over.
  absl::Status Superseded(const Session& session);
  // The error of a write to the upload's files: they are missing once it has been deleted, or
  // continues on another server.
  absl::Status WriteError(const Session& session, const absl::Status& error);
  // Also removes the files; the bytes still count toward the quota.
  void DropSession(const UploadRow& row);
  absl::Status PrepareUpload(const NewUpload& upload, Opening& opening);
  absl::Status StoreUpload(JobStore& store, Opening& opening);
  absl::Status CheckSameUpload(JobStore& store, const Opening& opening) const;
  absl::Status StoreReceivingJob(JobStore& store, Opening& opening);
  void GiveUp(const Opening& opening);
  UploadInfo InfoOf(const UploadRow& row) const;
  // Deletes an unfinished upload and ends the job that waits for it.
  void EndUpload(const std::string& tenant, const std::string& upload, JobState state,
                 const absl::Status& error, DoneStatus done = nullptr);
  absl::Status EraseUpload(JobStore& store, const UploadRow& row, JobState state,
                           const absl::Status& error, Erased& erased);
  VolumeRow NewVolume(const UploadRow& row, const std::string& digest) const;
  absl::Status StoreVolume(JobStore& store, Finishing& finishing);
  absl::Status StoreVolumeOfJob(JobStore& store, Finishing& finishing);
  void VolumeStored(const Finishing& finishing);

  // ---- Volumes
  VolumeInfo InfoOf(const VolumeRow& row) const;
  static absl::Status EraseVolume(JobStore& store, const VolumeRow& row, Erased& erased);

  // ---- Jobs
  absl::StatusOr<JobInfo> InfoOf(JobStore& store, const JobRow& row) const;
  JobInfo PlainInfoOf(const JobRow& row) const;
  absl::Status StoreJob(JobStore& store, Creating& creating);
  absl::Status InsertJob(JobStore& store, JobRow job, Creating& creating);
  absl::Status CheckJob(JobStore& store, Creating& creating);
  absl::Status CancelIfUnfinished(JobStore& store, const JobRow& job, Erased& erased);
  absl::Status EraseJob(JobStore& store, const JobRow& job, Erased& erased);
  Flow BeginWatch(std::string tenant, std::string job, uint64_t after_sequence,
                  std::shared_ptr<Watch> watch);

  // ---- What follows a change; on the loop
  void Apply(const Step& step);
  void Apply(const Erased& erased);
  // Runs a change that erases, and what follows it.
  Flow Erase(std::function<absl::Status(JobStore& store, Erased& erased)> change,
             DoneStatus done = nullptr);

  // ---- Runs; on the loop
  std::string ResultKey(const std::string& volume_digest, const std::string& options) const;
  // Stores the job's new state.
  absl::Status StoreState(JobStore& store, int64_t job, JobState state, const absl::Status& error,
                          int64_t result, std::vector<Step>& steps);
  // The same for jobs in memory, as a change of its own; repeated until the disk has room.
  Flow EnterState(std::set<int64_t> jobs, JobState state, absl::Status error = absl::OkStatus(),
                  int64_t result = 0);
  void Schedule();
  Flow BeginJobs();
  absl::Status BeginNext(JobStore& store, Claims& claims);
  enum class Begun { kYes, kClaim, kNothingNow };
  absl::StatusOr<Begun> BeginJob(JobStore& store, const ActiveJobs::Turn& turn, Claims& claims);
  Begun StartRun(const ActiveJobs::Turn& turn, const VolumeRow& volume, Claims& claims);
  Flow GiveWholeResult(JobRow job, std::string key);
  void WaitAgain(int64_t job);
  // Claims a waiting job for this server.
  absl::Status Claim(JobStore& store, Claiming& claiming);
  Flow ClaimAgain(Claiming claiming);
  void Claimed(const Claiming& claiming);
  Flow Feed(std::shared_ptr<Run> run, VolumeRow volume);
  // Checks the bytes of the run's volume if they came from a file. On the loop.
  Flow CheckBlobOf(std::shared_ptr<Run> run, DoneStatus done);
  Flow StoreResult(std::shared_ptr<Run> run, ResultRow row);
  // Yields whether the file is superfluous: no job needs it, or an equal result is stored.
  absl::StatusOr<bool> StoreResultOf(JobStore& store, const Run* run, ResultRow row,
                                     std::vector<Step>& steps);
  void RunFailed(Run* run, const absl::Status& error);
  void ReceivingFailed(int64_t job, const absl::Status& error);
  void JoinEqual(Run* run);
  Flow ReadResult(std::string tenant, std::string key,
                  std::function<void(std::optional<ResultRow>)> then);
  Flow DropResult(ResultRow row, std::function<void()> then);
  void GiveStoredResult(Run* run, int64_t result);
  std::map<int64_t, JobEvent> TakeProgress(Run& run);
  absl::Status StoreProgress(JobStore& store, const std::map<int64_t, JobEvent>& events);

  Flow OnRunVolume(std::shared_ptr<Run> run, std::string digest) override;
  Flow OnRunProgress(std::shared_ptr<Run> run) override;
  Flow OnRunEnd(std::shared_ptr<Run> run, absl::StatusOr<JobResult> result) override;

  // ---- The fleet; on the loop. Without other servers these do nothing.
  void MaintainFleet();
  // Applies the changes of other servers.
  void Sync();
  void Follow(const JobRow& job);
  void FollowDeleted(int64_t job);
  // Sends all events of the job to its watchers here.
  void TellStored(int64_t job);
  // Sends the newest progress of jobs that run elsewhere to their watchers here.
  void TellProgress();
  std::optional<JobEvent> ProgressElsewhere(JobStore& store, const JobRow& job) const;
  Flow Beat();
  absl::Status CountFiles(JobStore& store);
  Flow SweepShared();
  void CheckMembers();
  Flow TakeOverFrom(Member member);
  // Called after this server was fenced off: its runs now belong to others.
  void Rejoin();
  void QueueWaiting();

  // ---- Expiry; on the loop
  bool CleanUpIsDue() const;
  void CleanUp();
  std::vector<UploadRow> UnusedUploads(Time oldest);
  void ExpireUploads();
  void ExpireJobs();
  void ExpireVolumes();
  bool ClockIsTrusted();

  const DurableOptions options_;
  JobRunner& runner_;
  const JobCodec& codec_;
  const bool shared_;  // with other servers
  const BlobStore blobs_;
  DiskQuota quota_;
  std::atomic<bool> admitting_ = true;
  std::atomic<uint64_t> cached_ = 0;

  UploadTable uploads_;

  // These belong to the loop.
  FolderFiles folder_;
  JobJournal journal_;
  WatchBoard watches_;
  ActiveJobs active_;
  std::vector<std::function<void(bool)>> retries_;
  FleetMembers members_;
  std::chrono::steady_clock::time_point last_beat_, last_progress_;
  int64_t last_change_ = -1;
  int beats_ = 0, clean_ups_ = 0;
  bool stopping_ = false;
  bool scheduling_ = false;            // a change that claims jobs is in progress
  std::atomic<Time> next_clean_up_{};  // also read by the ticker
  ClockGuard clock_;

  Operations operations_;
  GroupCommit loop_;
  TaskThreads files_;
  std::atomic<bool> retry_wanted_ = false;
  std::mutex tick_mutex_;
  std::condition_variable_any tick_;
  std::jthread ticker_;  // last: uses all of the above
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_DURABLE_JOBS_H_
