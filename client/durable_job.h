#ifndef BCCSKEL_CLIENT_DURABLE_JOB_H_
#define BCCSKEL_CLIENT_DURABLE_JOB_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/call_options.h"
#include "core/exec/context.h"

// A server's report about a stored job.

namespace bccskel::client {

enum class JobState { kUnknown, kReceiving, kQueued, kRunning, kSucceeded, kFailed, kCancelled };

// "queued" and so on.
const char* NameOf(JobState state);
inline bool HasEnded(JobState state) { return state >= JobState::kSucceeded; }

enum class JobPriority { kLow, kNormal, kHigh };

using Time = std::chrono::system_clock::time_point;

struct DurableJob {
  std::string name;  // jobs/...
  JobState state = JobState::kUnknown;
  std::string request_id;
  std::string volume;  // volumes/...
  int attempts = 0;
  absl::Status error;  // of a job that failed or was cancelled
  uint64_t result_bytes = 0;
  Time created;
  std::optional<Time> started;
  std::optional<Time> ended;
  std::optional<Time> expires;
};

struct NewJob {
  std::string request_id;  // a repeat yields the same job; empty: a random one
  std::string volume;      // volumes/...
  SkeletonizeOptions options;
  ThinVolume thin_volume = ThinVolume::kOmit;
  JobPriority priority = JobPriority::kNormal;
  int threads = 0;
};

struct JobPage {
  std::vector<DurableJob> jobs;  // newest first
  std::string next_token;        // empty after the last page
};

// An event of a job: a change of its state, or a thinned shell.
struct JobEvent {
  uint64_t sequence = 0;
  std::optional<JobState> state;
  absl::Status error;  // of a job that failed or was cancelled
  std::optional<exec::ShellProgress> shell;
};

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_DURABLE_JOB_H_
