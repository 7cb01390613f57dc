#ifndef BCCSKEL_SERVER_STORE_ROWS_H_
#define BCCSKEL_SERVER_STORE_ROWS_H_

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace bccskel::server {

// What the job store keeps. Names are unique within their tenant; digests are 64 lower case
// hexadecimal digits. Times have microseconds.

using Time = std::chrono::system_clock::time_point;

// The numbers are stored: they never change.
enum class JobState {
  kReceiving = 0,  // its volume is still being uploaded
  kQueued = 1,
  kRunning = 2,
  kSucceeded = 3,  // this and what follows never changes
  kFailed = 4,
  kCancelled = 5,
};
constexpr bool IsTerminal(JobState state) { return state >= JobState::kSucceeded; }

struct UploadRow {
  std::string tenant;
  std::string name;  // uploads/...
  std::string declaration;
  uint64_t size_bytes = 0;  // as declared
  std::string job;          // that waits for it; empty without one
  std::string volume;       // what it has become; empty before
  Time used;                // last
  std::string file;         // where its bytes are; empty: a file named after the upload
};

struct VolumeRow {
  std::string tenant;
  std::string name;  // volumes/...
  std::string declaration;
  std::string blob_digest;    // SHA-256 of the bytes as sent
  std::string volume_digest;  // core/io/volume_digest.h; empty until a first job has decoded it
  uint64_t size_bytes = 0;
  Time created;
  Time used;  // last
};

struct ResultRow {
  int64_t number = 0;  // given by the store
  std::string tenant;
  std::string key;          // what it is the result of; unique within the tenant
  std::string file;         // its name; empty once it was found damaged
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
  std::string body;        // what was asked for, to tell a repeat from a reuse
  std::string upload;      // that it came with; empty for a job made from a volume
  std::string options;
  int priority = 0;
  int threads = 0;    // wanted; 0 leaves it to the server
  std::string trace;  // the traceparent of the call that made it, for the log; may be empty
  Time created;

  // From here on what changes.
  std::string volume;  // empty while it is received
  JobState state = JobState::kQueued;
  int attempts = 0;       // begun
  int crashes = 0;        // of the server while it ran
  uint64_t sequence = 0;  // of the last event that was stored
  std::string owner;      // the process that runs it; empty when none does
  absl::Status error;     // why it failed; details as payloads, see proto/wire/error_details.h
  int64_t result = 0;     // a ResultRow's number
  std::optional<Time> started;  // the last attempt
  std::optional<Time> ended;
};

// A job's place among its tenant's, which tells nothing of others and outlasts the job.
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

// A file that nobody wants any more: it goes, and then the row. So a crash between the two leaves
// nothing behind, and no file has to go because nobody knows it.
struct RemovalRow {
  // The numbers are stored.
  enum class Kind { kUpload = 0, kBlob = 1, kResult = 2, kUploadFile = 3 };
  Kind kind = Kind::kUpload;
  std::string tenant;
  std::string name;  // of the upload; the blob's digest; of the result's or the upload's file
};

// What a running job has told last, if nothing was lost. Bytes of the one who runs it.
struct ProgressRow {
  uint64_t sequence = 0;
  std::string bytes;
};

// A server of the fleet.
struct Member {
  std::string server;
  int64_t beats = 0;  // signs of life
};

// Jobs that are new or other than before, each as it is now.
struct JobChanges {
  std::vector<JobRow> jobs;
  std::vector<int64_t> deleted;  // their numbers
  int64_t last = 0;              // go on from here
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_ROWS_H_
