#ifndef BCCSKEL_SERVER_DURABLE_ACTIVE_JOBS_H_
#define BCCSKEL_SERVER_DURABLE_ACTIVE_JOBS_H_

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/durable/run.h"
#include "server/jobs/fair_queue.h"
#include "server/store/rows.h"

namespace bccskel::server {

// What DurableJobs remembers of unfinished jobs.

// A job that waits. One that ran while the server crashed may be the reason: it is a suspect.
struct WaitingJob {
  int64_t job = 0;
  bool suspect = false;
};
using JobQueue = FairQueue<WaitingJob, std::chrono::system_clock>;
// An unfinished job. Its row is what the store has.
struct ActiveJob {
  JobRow row;
  Run* run = nullptr;                    // that computes it, or decodes its volume while it comes
  std::optional<JobQueue::Entry> place;  // in the queue
};
// A computation. Jobs that want the same share it.
struct ActiveRun {
  enum class Source { kUpload, kFile };
  std::shared_ptr<Run> run;
  Source source = Source::kFile;
  std::string tenant;
  std::string options;
  std::string volume;         // its name; empty while it is received
  std::string volume_digest;  // empty until it is decoded
  std::set<int64_t> jobs;
  int crashes = 0;      // of the server, of the job that it was begun for
  bool ending = false;  // nobody joins any more
  std::chrono::steady_clock::time_point fed;  // when it was given its volume
  bool computed = false;                      // its result is being written
};
// A job's new state, and the event that tells it; none where the job had ended before.
struct Step {
  JobRow job;
  std::optional<EventRow> event;
};
// What a change has deleted, for its end.
struct Erased {
  std::vector<Step> steps;
  std::vector<UploadRow> uploads;  // unfinished ones
  std::vector<ResultRow> results;
  std::vector<VolumeRow> blobs;  // whose bytes no volume may have any more
  enum class Traces { kMayStay, kErase } traces = Traces::kMayStay;  // in the store's files
};
// Of another server: how many it has given, and since when no other.
struct Sign {
  int64_t beats = 0;
  std::chrono::steady_clock::time_point since;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_ACTIVE_JOBS_H_
