#ifndef BCCSKEL_SERVER_DURABLE_LEDGER_H_
#define BCCSKEL_SERVER_DURABLE_LEDGER_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/digest/sha256.h"
#include "server/durable/durable_options.h"
#include "server/durable/job_codec.h"
#include "server/durable/records.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// Hears of a job. Called on the ledger's thread; must not block.
class JobWatcher {
 public:
  virtual ~JobWatcher() = default;
  // In order of sequence. State changes are lossless; of shells only the newest is told.
  virtual void OnEvent(const JobEvent& event) = 0;
  // Once, last: OK after the completed event; NOT_FOUND; UNAVAILABLE when the server stops.
  virtual void OnWatchEnd(const absl::Status& status) = 0;
};

// Ends a watch when it is destroyed: no call of the watcher begins after that.
class WatchHandle {
 public:
  virtual ~WatchHandle() = default;
};

// Reads a stored result record by record. The file stays readable while the reader lives, whatever
// is deleted or expires meanwhile.
// Threads: one call of Next() at a time.
class ResultReader {
 public:
  virtual ~ResultReader() = default;
  // Nothing after the last record. Errors: DATA_LOSS; INTERNAL.
  virtual void Next(std::function<void(absl::StatusOr<std::optional<ResultRecord>>)> done) = 0;
};

// Uploads, volumes, jobs and results that survive the process: what a callback has confirmed with
// OK is on disk. Every function returns at once; `done` is called exactly once, on a thread of the
// ledger, and must not block. Every name is looked up within the tenant: those of others are
// NOT_FOUND.
// Errors of all: NOT_FOUND for names; RESOURCE_EXHAUSTED when the disk is full; UNAVAILABLE when
// the server is draining; INTERNAL. Threads: safe.
class Ledger {
 public:
  template <typename Value>
  using Done = std::function<void(absl::StatusOr<Value>)>;
  using DoneStatus = std::function<void(absl::Status)>;

  // Opens the data directory, finishes what a crash has left, and goes on with unfinished jobs.
  // Needs: `runner` and `codec` outlive the ledger. Blocks; may take as long as reading all
  //        unfinished uploads.
  // Errors: ALREADY_EXISTS when another process owns the directory; FAILED_PRECONDITION for a
  //         directory of a newer version, and for files that are not those of its job store;
  //         RESOURCE_EXHAUSTED; DATA_LOSS for a damaged job store.
  static absl::StatusOr<std::unique_ptr<Ledger>> Open(const DurableOptions& options,
                                                      JobRunner& runner, const JobCodec& codec);
  // Stops: running jobs go back to the queue, without an attempt lost; watches end. Waits for what
  // is under way. Needs: no call any more, readers and handles of watches included.
  virtual ~Ledger() = default;

  // New uploads and jobs are refused as kDraining; no further job begins to run.
  virtual void StopAdmitting() = 0;

  // ---- Uploads. Chunks have at most 1 MiB.

  struct NewUpload {
    // "uploads/" and 1 to 64 of a-z, A-Z, 0-9, '-', '_'; empty: the ledger makes one up. The same
    // again, with the same declaration and job, yields the upload as it is.
    std::string name;
    std::string declaration;
    // A job that is to run as soon as the volume is complete: the one-call path. It is in state
    // kReceiving from the moment of `done`; its volume is decoded while it comes, when the runner
    // has a place.
    struct ThenJob {
      std::string options;
      int priority = 0;
      int threads = 0;         // wanted; 0 leaves it to the server
      std::string trace = {};  // for the log
    };
    std::optional<ThenJob> then_job;
  };
  // Errors: INVALID_ARGUMENT; ALREADY_EXISTS for a name that was used with something else;
  //         RESOURCE_EXHAUSTED for a quota; with a job the runner's.
  virtual void CreateUpload(const std::string& tenant, const NewUpload& upload,
                            Done<UploadInfo> done) = 0;
  // Yields the committed size. `done` comes when there is room for more. Without `crc32c` (of
  // `bytes`) no check is made.
  // Errors: OUT_OF_RANGE with the payload CommittedSizeOf() for a wrong offset and for more than
  //         was declared; ABORTED while another Append() or FinishUpload() is under way;
  //         INVALID_ARGUMENT for a wrong checksum or, decoded along, a malformed volume;
  //         FAILED_PRECONDITION after the upload was finished.
  virtual void Append(const std::string& tenant, const std::string& upload, uint64_t offset,
                      std::string bytes, std::optional<uint32_t> crc32c, Done<uint64_t> done) = 0;
  // Nobody sends just now: what was decoded along is dropped and its memory given back. The upload
  // stays and can be gone on with.
  virtual void SenderGone(const std::string& tenant, const std::string& upload) = 0;
  virtual void GetUpload(const std::string& tenant, const std::string& upload,
                         Done<UploadInfo> done) = 0;
  // Makes the upload a volume, and queues the job that waits for it. Finishing again yields the
  // same volume.
  // Errors: OUT_OF_RANGE with the committed size while bytes are missing; INVALID_ARGUMENT for
  //         another size or digest than that of the bytes (then the upload is gone); ABORTED.
  virtual void FinishUpload(const std::string& tenant, const std::string& upload,
                            uint64_t size_bytes, std::optional<Sha256Digest> sha256,
                            Done<VolumeInfo> done) = 0;
  // Also cancels the job that waits for it.
  virtual void DeleteUpload(const std::string& tenant, const std::string& upload,
                            DoneStatus done) = 0;

  // ---- Volumes

  // Those that the tenant has, of blob or volume digests (64 hexadecimal digits). The same bytes
  // may be several volumes, declared differently.
  virtual void FindVolumes(const std::string& tenant, const std::vector<std::string>& digests,
                           Done<std::vector<VolumeInfo>> done) = 0;
  virtual void GetVolume(const std::string& tenant, const std::string& volume,
                         Done<VolumeInfo> done) = 0;
  // Erases the bytes. Errors: FAILED_PRECONDITION while an unfinished job needs it.
  virtual void DeleteVolume(const std::string& tenant, const std::string& volume,
                            DoneStatus done) = 0;

  // ---- Jobs

  struct NewJob {
    enum class Mode { kCreate, kValidateOnly };
    std::string request_id;  // the same again yields the same job; empty: never the same
    std::string volume;
    std::string options;
    int priority = 0;        // a level is worth half a minute of waiting, within the tenant
    int threads = 0;         // wanted; 0 leaves it to the server
    std::string trace = {};  // for the log; a repeat may have another
    Mode mode = Mode::kCreate;
  };
  // With kValidateOnly the job that would be made, without a name.
  // Errors: FAILED_PRECONDITION when there is no such volume; ALREADY_EXISTS for a request_id that
  //         was used with something else; INVALID_ARGUMENT; RESOURCE_EXHAUSTED for a volume that
  //         can never be admitted; kQueueFull.
  virtual void CreateJob(const std::string& tenant, const NewJob& job, Done<JobInfo> done) = 0;
  virtual void GetJob(const std::string& tenant, const std::string& job, Done<JobInfo> done) = 0;
  struct JobQuery {
    int page_size = 50;            // at most; 1..1000
    std::string page_token;        // empty for the first page
    std::vector<JobState> states;  // only these; none means all
  };
  // Errors: INVALID_ARGUMENT for a token that did not come with these states.
  virtual void ListJobs(const std::string& tenant, const JobQuery& query, Done<JobPage> done) = 0;
  // Yields the job as it is then: cancelled, unless it had ended before.
  virtual void CancelJob(const std::string& tenant, const std::string& job, Done<JobInfo> done) = 0;
  // Erases the job, its upload if unfinished, and its result unless another job has the same. A job
  // that has not ended is cancelled first.
  virtual void DeleteJob(const std::string& tenant, const std::string& job, DoneStatus done) = 0;
  // Events after `after_sequence`, and the end in any case; 0 for all.
  virtual std::unique_ptr<WatchHandle> WatchJob(const std::string& tenant, const std::string& job,
                                                uint64_t after_sequence,
                                                std::shared_ptr<JobWatcher> watcher) = 0;
  // Errors: FAILED_PRECONDITION for a job that has not succeeded; OUT_OF_RANGE for a record beyond
  //         the end (the number of records itself is fine); DATA_LOSS for a damaged file.
  virtual void OpenResult(const std::string& tenant, const std::string& job, uint64_t first_record,
                          Done<std::shared_ptr<ResultReader>> done) = 0;

  // ---- Metrics

  struct Usage {
    uint64_t disk_bytes = 0;
    uint64_t disk_available_bytes = 0;  // up to the quota, or to the end of the file system
    int uploads = 0;                    // unfinished
    int queued = 0;                     // jobs
    int running = 0;                    // jobs
    uint64_t commits = 0;               // transactions since the start
    uint64_t cached = 0;                // jobs since the start that were given a stored result
  };
  virtual Usage usage() const = 0;
  // Why what is confirmed now could be lost, or what is read be wrong: the tables are damaged or
  // gone. OK else, and on a full disk.
  virtual absl::Status Health() const = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_LEDGER_H_
