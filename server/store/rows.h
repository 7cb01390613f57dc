#ifndef BCCSKEL_SERVER_STORE_ROWS_H_
#define BCCSKEL_SERVER_STORE_ROWS_H_

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace bccskel::server {

// The rows of the job store. Names are unique within their tenant; digests are 64 lowercase
// hexadecimal digits. Times have a resolution of microseconds.

using Time = std::chrono::system_clock::time_point;

// The numbers are stored and must never change.
enum class JobState {
  kReceiving = 0,  // its volume is still being uploaded
  kQueued = 1,
  kRunning = 2,
  kSucceeded = 3,  // final, as are the states below
  kFailed = 4,
  kCancelled = 5,
};
constexpr bool IsTerminal(JobState state) { return state >= JobState::kSucceeded; }

struct UploadRow {
  std::string tenant;
  std::string name;  // uploads/...
  std::string declaration;
  uint64_t size_bytes = 0;  // as declared
  std::string job;          // that waits for the upload; empty if none
  std::string volume;       // made from the upload; empty before
  Time used;                // last
  std::string file;         // the random name of the file with its bytes
};

struct VolumeRow {
  std::string tenant;
  std::string name;  // volumes/...
  std::string declaration;
  std::string blob_digest;    // SHA-256 of the bytes as sent
  std::string volume_digest;  // core/io/volume_digest.h; empty until a job has decoded it
  uint64_t size_bytes = 0;
  Time created;
  Time used;  // last
};

struct ResultRow {
  int64_t number = 0;  // given by the store
  std::string tenant;
  std::string key;          // identifies the computation; unique within the tenant
  std::string file;         // its name; empty once found damaged
  std::string file_digest;  // SHA-256 of the file's bytes
  uint64_t bytes = 0;
  uint64_t records = 0;
  std::string summary;
};

struct JobRow {
  int64_t number = 0;  // given by the store; later jobs have larger ones
  std::string tenant;
  std::string name;        // jobs/...
  std::string request_id;  // empty: none
  std::string body;        // the request, to tell a repeat from a reuse
  std::string upload;      // that brought the volume; empty for a job of a stored volume
  std::string options;
  int priority = 0;
  int threads = 0;    // wanted; 0 leaves it to the server
  std::string trace;  // traceparent of the creating call, for the log; may be empty
  Time created;

  // The fields below change.
  std::string volume;  // empty during the upload
  JobState state = JobState::kQueued;
  int attempts = 0;       // begun
  int crashes = 0;        // of the server while the job ran
  uint64_t sequence = 0;  // of the last stored event
  std::string owner;      // the process that runs the job; empty if none
  // Why it failed or waits again; details as payloads, see proto/wire/error_details.h.
  absl::Status error;
  int64_t result = 0;           // a ResultRow's number
  std::optional<Time> started;  // the last attempt
  std::optional<Time> ended;
};

// A job's position among its tenant's jobs. It reveals nothing about others and outlasts the job.
struct JobPosition {
  Time created;
  std::string name;
};

struct EventRow {
  int64_t job = 0;  // a JobRow's number
  uint64_t sequence = 0;
  Time time;
  JobState state = JobState::kQueued;
  int attempt = 0;
  absl::Status error;
};

// A file to be deleted: first the file goes, then this row. So a crash in between leaves nothing
// behind, and no file is deleted merely because no row names it.
struct RemovalRow {
  // The numbers are stored and must never change.
  enum class Kind { kUpload = 0, kBlob = 1, kResult = 2 };
  Kind kind = Kind::kUpload;
  std::string tenant;
  std::string name;  // of the upload's or result's file; the blob's digest
};

// The last progress of a running job, which may be lost. Only its server interprets the bytes.
struct ProgressRow {
  uint64_t sequence = 0;
  std::string bytes;
};

// A server of the fleet.
struct Member {
  std::string server;
  int64_t beats = 0;  // heartbeats
};

// New and changed jobs in their current state.
struct JobChanges {
  std::vector<JobRow> jobs;
  std::vector<int64_t> deleted;  // their numbers
  int64_t last = 0;              // where to continue
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_ROWS_H_
