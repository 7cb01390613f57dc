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
// OK is on disk. Every function returns at once; `done` is called exactly once, on a thread of the
// DurableJobs, and must not block. Every name is looked up within the tenant: those of others are
// NOT_FOUND.
// Errors of all: NOT_FOUND for names; RESOURCE_EXHAUSTED when the disk is full; UNAVAILABLE when
// the server is draining; INTERNAL. Threads: safe.
//
// What is remembered here, but for uploads, belongs to the loop: the thread of the job store. An
// operation is a flow, which waits for changes, which alone write the store, and goes on on the
// loop once they are on disk; there alone what is remembered is changed. Bytes of files are read
// and written on other threads, to which flows go over.
//
// Its parts: UploadTable and ActiveJobs remember what is unfinished, JobJournal changes states,
// WatchBoard tells events, FolderFiles keeps files and tables together, FleetMembers tells who is
// gone. durable_jobs.cc opens and closes; uploads.cc, volumes.cc and jobs.cc answer callers;
// runs.cc and results.cc compute; expiry.cc cleans up.
//
// Several processes may share the store and the folder. Each then remembers the unfinished jobs of
// all, as of a moment ago; changes find out in the store how things are. fleet.cc follows
// what others do, and takes over from those that are gone.
class DurableJobs final : public RunObserver {
 public:
  template <typename Value>
  using Done = std::function<void(absl::StatusOr<Value>)>;
  using DoneStatus = std::function<void(absl::Status)>;

  // Opens the data directory, finishes what a crash has left, and goes on with unfinished jobs.
  // Needs: `runner` and `codec` outlive DurableJobs. Blocks; may take as long as reading all
  //        unfinished uploads.
  // Errors: ALREADY_EXISTS when another process owns the directory; FAILED_PRECONDITION for a
  //         directory of a newer version, and for files that are not those of its job store;
  //         RESOURCE_EXHAUSTED; DATA_LOSS for a damaged job store.
  static absl::StatusOr<std::unique_ptr<DurableJobs>> Open(const DurableOptions& options,
                                                           JobRunner& runner,
                                                           const JobCodec& codec);
  // Stops: running jobs go back to the queue, without an attempt lost; watches end. Waits for what
  // is under way. Needs: no call any more, readers included.
  ~DurableJobs() override;

  // New uploads and jobs are refused as kDraining; no further job begins to run.
  void StopAdmitting() { admitting_ = false; }

  // ---- Uploads. Chunks have at most 1 MiB.

  // Errors: INVALID_ARGUMENT; ALREADY_EXISTS for a name that was used with something else;
  //         RESOURCE_EXHAUSTED for a quota; with a job the runner's.
  Flow CreateUpload(std::string tenant, NewUpload upload, Done<UploadInfo> done);
  // Yields the committed size. `done` comes when there is room for more. Without `crc32c` (of
  // `bytes`) no check is made.
  // Errors: OUT_OF_RANGE with the payload CommittedSizeOf() for a wrong offset and for more than
  //         was declared; ABORTED while another Append() or FinishUpload() is under way;
  //         INVALID_ARGUMENT for a wrong checksum or, decoded along, a malformed volume;
  //         FAILED_PRECONDITION after the upload was finished.
  Flow Append(std::string tenant, std::string upload, uint64_t offset, std::string bytes,
              std::optional<uint32_t> crc32c, Done<uint64_t> done);
  // Nobody sends just now: what was decoded along is dropped and its memory given back. The upload
  // stays and can be gone on with.
  void SenderGone(const std::string& tenant, const std::string& upload);
  Flow GetUpload(std::string tenant, std::string upload, Done<UploadInfo> done);
  // Makes the upload a volume, and queues the job that waits for it. Finishing again yields the
  // same volume.
  // Errors: OUT_OF_RANGE with the committed size while bytes are missing; INVALID_ARGUMENT for
  //         another size or digest than that of the bytes (then the upload is gone); ABORTED.
  Flow FinishUpload(std::string tenant, std::string upload, uint64_t size_bytes,
                    std::optional<Sha256Digest> sha256, Done<VolumeInfo> done);
  // Also cancels the job that waits for it.
  void DeleteUpload(const std::string& tenant, const std::string& upload, DoneStatus done);

  // ---- Volumes

  // Those that the tenant has, of blob or volume digests (64 hexadecimal digits). The same bytes
  // may be several volumes, declared differently.
  Flow FindVolumes(std::string tenant, std::vector<std::string> digests,
                   Done<std::vector<VolumeInfo>> done);
  // Erases the bytes. Errors: FAILED_PRECONDITION while an unfinished job needs it.
  void DeleteVolume(const std::string& tenant, const std::string& volume, DoneStatus done);

  // ---- Jobs

  // With kValidateOnly the job that would be made, without a name.
  // Errors: FAILED_PRECONDITION when there is no such volume; ALREADY_EXISTS for a request_id that
  //         was used with something else; INVALID_ARGUMENT; RESOURCE_EXHAUSTED for a volume that
  //         can never be admitted; kQueueFull.
  Flow CreateJob(std::string tenant, NewJob job, Done<JobInfo> done);
  Flow GetJob(std::string tenant, std::string job, Done<JobInfo> done);
  // Errors: INVALID_ARGUMENT for a token that did not come with these states.
  Flow ListJobs(std::string tenant, JobQuery query, Done<JobPage> done);
  // Yields the job as it is then: cancelled, unless it had ended before.
  Flow CancelJob(std::string tenant, std::string job, Done<JobInfo> done);
  // Erases the job, its upload if unfinished, and its result unless another job has the same. A job
  // that has not ended is cancelled first.
  void DeleteJob(const std::string& tenant, const std::string& job, DoneStatus done);
  // Events after `after_sequence`, and the end in any case; 0 for all. Until the watch is stopped.
  std::shared_ptr<Watch> WatchJob(const std::string& tenant, const std::string& job,
                                  uint64_t after_sequence, std::shared_ptr<JobWatcher> watcher);
  // Errors: FAILED_PRECONDITION for a job that has not succeeded; OUT_OF_RANGE for a record beyond
  //         the end (the number of records itself is fine); DATA_LOSS for a damaged file.
  Flow OpenResult(std::string tenant, std::string job, uint64_t first_record,
                  Done<std::shared_ptr<ResultReader>> done);

  // ---- Metrics

  DurableUsage usage() const;
  // Why what is confirmed now could be lost, or what is read be wrong: the tables are damaged or
  // gone. OK else, and on a full disk.
  absl::Status Health() const { return loop_.Health(); }

  // Use Open(). Recover() comes next, once.
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
  // What a change has deleted, for its end.
  struct Erased {
    std::vector<Step> steps;
    std::vector<UploadRow> uploads;  // unfinished ones
    std::vector<ResultRow> results;
    std::vector<VolumeRow> blobs;  // whose bytes no volume may have any more
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
  // A change, which may run several times. They go on at its end, with its error.
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
  // Another try, soon; false: there is none any more.
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
  // The stored result, read to its end: a damaged one is dropped, and there is none. On the loop.
  auto WholeResult(const std::string& tenant, const std::string& key) {
    return Await<std::optional<ResultRow>>(
        [this, &tenant, &key](auto resume) { ReadResult(tenant, key, resume); });
  }
  auto Dropped(const ResultRow& row) {
    return Await<std::monostate>([this, &row](auto resume) { DropResult(row, resume); });
  }

  // As the runner is to be asked.
  static JobRequest RunnerRequest(JobRequest request, const JobRow& job);
  absl::Status CheckAdmitting() const;
  absl::Status CheckFits(const JobRequest& request) const;
  absl::Status CheckRoomForJob() const;
  // As precise as the store: what callers are told does not change when it is read back.
  Time Now() const { return std::chrono::floor<std::chrono::microseconds>(options_.now()); }

  // ---- Uploads
  // The session of an unfinished upload; another server's is taken over. Errors: NOT_FOUND;
  // FAILED_PRECONDITION for a finished upload; ABORTED while it is being opened.
  Flow OpenSession(std::string tenant, std::string upload, Done<Session> done);
  static absl::Status StoreMove(JobStore& store, const UploadRow& old, const std::string& to);
  // Another server has taken the upload over.
  absl::Status Superseded(const Session& session);
  // Removes the files, too; the bytes stay counted.
  void DropSession(const UploadRow& row);
  static RemovalRow RemovalOf(const UploadRow& row);
  absl::Status PrepareUpload(const NewUpload& upload, Opening& opening);
  absl::Status StoreUpload(JobStore& store, Opening& opening);
  absl::Status CheckSameUpload(JobStore& store, const Opening& opening) const;
  absl::Status StoreReceivingJob(JobStore& store, Opening& opening);
  void GiveUp(const Opening& opening);
  UploadInfo InfoOf(const UploadRow& row) const;
  // Takes an unfinished upload away, and ends the job that waits for it.
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
  // A change that erases, and what follows.
  Flow Erase(std::function<absl::Status(JobStore& store, Erased& erased)> change,
             DoneStatus done = nullptr);

  // ---- Runs; on the loop
  std::string ResultKey(const std::string& volume_digest, const std::string& options) const;
  // Brings the stored job into a state.
  absl::Status StoreState(JobStore& store, int64_t job, JobState state, const absl::Status& error,
                          int64_t result, std::vector<Step>& steps);
  // The same for jobs that are remembered, as a change of its own; repeated until the disk takes
  // it.
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
  // Brings a waiting job to run here.
  absl::Status Claim(JobStore& store, Claiming& claiming);
  Flow ClaimAgain(Claiming claiming);
  void Claimed(const Claiming& claiming);
  Flow Feed(std::shared_ptr<Run> run, VolumeRow volume);
  // The bytes of its volume, where they came from a file. On the loop.
  Flow CheckBlobOf(std::shared_ptr<Run> run, DoneStatus done);
  Flow StoreResult(std::shared_ptr<Run> run, ResultRow row);
  // Yields whether the file is needless: nobody wants it, or an equal one was there.
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

  // ---- The fleet; on the loop. Where nobody shares the store, nothing happens.
  void LookAfterFleet();
  // Follows what others have changed.
  void Sync();
  void Follow(const JobRow& job);
  void FollowDeleted(int64_t job);
  // All events of the job to who watches it here.
  void TellStored(int64_t job);
  // The newest progress of jobs that run elsewhere to who watches them here.
  void TellProgress();
  std::optional<JobEvent> ProgressElsewhere(JobStore& store, const JobRow& job) const;
  Flow Beat();
  absl::Status CountFiles(JobStore& store);
  Flow SweepShared();
  void LookAtMembers();
  Flow TakeOverFrom(Member member);
  // After this server was fenced off: what it ran is others' now.
  void Rejoin();
  void QueueWaiting();

  // ---- Expiry; on the loop
  bool CleanUpIsDue() const;
  void CleanUp();
  std::vector<UploadRow> UnusedUploads(Time oldest);
  void ExpireUploads();
  void ExpireJobs();
  void ExpireVolumes();
  bool ClockIsBelieved();

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
  bool scheduling_ = false;            // a change that claims jobs is on its way
  std::atomic<Time> next_clean_up_{};  // the ticker looks at it, too
  ClockGuard clock_;

  Operations operations_;
  GroupCommit loop_;
  TaskThreads files_;
  std::atomic<bool> retry_wanted_ = false;
  std::mutex tick_mutex_;
  std::condition_variable_any tick_;
  std::jthread ticker_;  // last: it uses all of these
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_DURABLE_JOBS_H_
