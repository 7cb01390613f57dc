#ifndef BCCSKEL_SERVER_DURABLE_RECORDS_H_
#define BCCSKEL_SERVER_DURABLE_RECORDS_H_

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "server/store/rows.h"

namespace bccskel::server {

// Uploads, volumes and jobs as callers see them: their rows and derived values. Every name belongs
// to one tenant; for any other it does not exist.
//
// `declaration` and `options` are bytes that DurableJobs stores and compares but does not read: see
// JobCodec. Equal bytes mean the same thing.
struct UploadInfo : UploadRow {
  uint64_t committed_bytes = 0;  // resume from here
  Time expires;                  // unless bytes arrive
};

struct VolumeInfo : VolumeRow {
  Time expires;  // unless it is used
};

struct JobProgress {
  exec::ShellProgress shell;
  std::chrono::nanoseconds elapsed{0};  // since the computation began
};

struct JobInfo : JobRow {
  uint64_t result_records = 0;  // of a job that succeeded
  uint64_t result_bytes = 0;
  std::string summary;                  // its last record; empty in lists
  std::optional<JobProgress> progress;  // of a running job, once there is one; not in lists
  std::optional<Time> expires;          // once it has ended
};

struct JobPage {
  std::vector<JobInfo> jobs;  // newest first
  std::string next_token;     // empty after the last page
};

// One event of a job. Sequence numbers of a job increase, also across restarts, with gaps.
struct JobEvent {
  struct StateChange {
    JobState state = JobState::kQueued;
    int attempt = 0;
    absl::Status error;  // of a failed job
  };
  uint64_t sequence = 0;  // from 1
  Time time;
  std::variant<StateChange, JobProgress> what;

  // Whether this is the last event of the job.
  bool IsCompleted() const {
    const auto* change = std::get_if<StateChange>(&what);
    return change != nullptr && IsTerminal(change->state);
  }
};

// A result is a list of records: the chunks of the skeleton, then those of the thinned volume, then
// the summary. So record n is skeleton chunk n.
struct ResultRecord {
  enum class Kind : uint8_t { kSkeletonChunk = 1, kThinVolumeChunk = 2, kSummary = 3 };
  Kind kind = Kind::kSkeletonChunk;
  std::string bytes;  // the serialized message of that name
};

// ---- What callers ask for.

struct NewUpload {
  // "uploads/" and 1 to 64 of a-z, A-Z, 0-9, '-', '_'; empty: DurableJobs chooses one. Repeating a
  // name with the same declaration and job yields the existing upload.
  std::string name = {};
  std::string declaration;
  // A job that runs as soon as the volume is complete: the one-call path. It is in state kReceiving
  // from the call of `done` on; its volume is decoded during the upload if the runner has a place.
  struct ThenJob {
    std::string options;
    int priority = 0;
    int threads = 0;         // wanted; 0 leaves it to the server
    std::string trace = {};  // for the log
  };
  std::optional<ThenJob> then_job = {};
};

struct NewJob {
  enum class Mode { kCreate, kValidateOnly };
  std::string request_id;  // a repeat yields the same job; empty: each request is new
  std::string volume;
  std::string options;
  int priority = 0;        // a level equals half a minute of waiting, within the tenant
  int threads = 0;         // wanted; 0 leaves it to the server
  std::string trace = {};  // for the log; may differ in a repeat
  Mode mode = Mode::kCreate;
};

struct JobQuery {
  int page_size = 50;            // at most; 1..1000
  std::string page_token;        // empty for the first page
  std::vector<JobState> states;  // only these; none means all
};

struct DurableUsage {
  bool healthy = true;  // as DurableJobs::Health()
  uint64_t disk_bytes = 0;
  uint64_t disk_available_bytes = 0;  // up to the quota, or to the end of the file system
  int uploads = 0;                    // unfinished
  int queued = 0;                     // jobs
  int running = 0;                    // jobs
  uint64_t cached = 0;  // jobs since the start that were answered from a stored result
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_RECORDS_H_
