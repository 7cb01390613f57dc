#ifndef BCCSKEL_SERVER_JOBS_JOB_RUNNER_H_
#define BCCSKEL_SERVER_JOBS_JOB_RUNNER_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/digest/sha256.h"
#include "core/exec/context.h"
#include "core/io/volume_header.h"
#include "core/labels/skeletonize_labels.h"
#include "core/pipeline/skeletonize.h"
#include "server/admission/admission.h"
#include "server/admission/memory_estimate.h"
#include "server/jobs/fair_queue.h"

namespace bccskel::server {

// Interval between two progress reports to callers; the newest is always sent. Each reply costs
// about 30 us on either side. gRPC's threads that send it, and a caller on the same machine,
// interrupt workers in lockstep for ten times as long: with one reply per millisecond two threads
// were slower than one.
inline constexpr std::chrono::milliseconds kProgressInterval{10};

// Time that a job spent in each phase.
struct JobTimes {
  std::chrono::nanoseconds queued{0};    // waiting for threads
  std::chrono::nanoseconds decoded{0};   // in the decoder
  std::chrono::nanoseconds computed{0};  // from begin to end of each turn
};

// How a job ended, for metrics.
struct JobEnd {
  std::string tenant;
  absl::Status status;
  JobTimes times;
  uint64_t object_points = 0;
};

// Observes all jobs of a runner, on any thread. Learns of an end before the job's listener does.
struct JobObserver {
  std::function<void(uint64_t volume_bytes)> on_admitted = [](uint64_t) {};
  std::function<void(const JobEnd& end)> on_end = [](const JobEnd&) {};
};

// The options common to all requests.
struct JobWish {
  JobOrigin origin;
  uint64_t size_bytes = 0;  // of the encoded volume
  SkeletonizeOptions options;
  int threads_wanted = 0;  // 0 leaves it to the server
  // Memory that the job holds at least, from its admission to its end.
  uint64_t min_bytes = 0;
  exec::Context::Clock::time_point deadline = exec::Context::Clock::time_point::max();
};

// A request for a volume of one object.
struct JobRequest : JobWish {
  VolumeHeader header;  // as declared and completed; not yet compared with the bytes
  std::optional<VolumeEncoding> thin_volume;  // encoding of the thinned volume, if requested
  ShellPointsWanted shell_points = ShellPointsWanted::kNone;
};

// Memory of a graph.
inline uint64_t GraphBytes(const SkeletonGraph& graph) {
  return graph.nodes.size() * sizeof(SkeletonNode) + graph.edges.size() * sizeof(SkeletonEdge) +
         (graph.points.size() + graph.sheets.size()) * sizeof(SkeletonPoint);
}

struct JobResult {
  SkeletonizeResult skeleton;
  std::string thin_volume;  // encoded; empty unless requested
  JobTimes times;
  int threads = 1;
  Ticket ticket;  // keeps the result's memory reserved while the result lives
};

// Receives the news of a job. Called on the job's threads, never from inside a call to the job;
// must not block.
class UploadListener {
 public:
  virtual ~UploadListener() = default;
  // The bytes of the last Append() are decoded: there is room for more. May be called after
  // OnEnd().
  virtual void OnBytesConsumed() = 0;
};

class JobListener : public UploadListener {
 public:
  // The volume is complete and decoded; from here on the job waits for threads.
  virtual void OnVolume(const Volume&) {}
  // `elapsed` since the computation began.
  virtual void OnShell(const exec::ShellProgress& progress, std::chrono::nanoseconds elapsed) = 0;
  // The points of a thinned shell, if requested. Yields the bytes that the listener keeps of them,
  // for which the job has reserved memory until the result is released.
  virtual uint64_t OnShellPoints(int32_t, const Volume&) { return 0; }
  // Exactly once, whatever happens.
  virtual void OnEnd(absl::StatusOr<JobResult> result) = 0;
};

// A request for a volume of labels.
struct LabelsRequest : JobWish {
  LabelVolumeHeader header;      // as declared, with the worst case for missing promises
  std::vector<uint64_t> labels;  // empty means all
  uint64_t min_voxels = 0;
};

struct LabelResult {
  LabelSkeleton skeleton;  // without its thin volume
  int threads = 1;
  std::shared_ptr<void> memory;  // released with the result; the job may wait for that
};

struct LabelsResult {
  uint64_t labels = 0;   // computed
  uint64_t skipped = 0;  // too small
  uint64_t absent = 0;   // requested, but without a voxel
  uint64_t voxels = 0;
  uint64_t object_points = 0;
  uint64_t skeleton_points = 0;
  int threads = 1;
  JobTimes times;
  Ticket ticket;  // for results that are not released yet
};

class LabelsListener : public UploadListener {
 public:
  // `elapsed` since the computation began.
  virtual void OnProgress(uint64_t done, uint64_t total, std::chrono::nanoseconds elapsed) = 0;
  // Called in ascending order of labels, before OnEnd().
  virtual void OnLabel(LabelResult result) = 0;
  // Exactly once, whatever happens.
  virtual void OnEnd(absl::StatusOr<LabelsResult> result) = 0;
};

// An admitted job. No call blocks. A job continues after its handle is dropped; Cancel() ends it.
// Threads: safe.
class Job {
 public:
  virtual ~Job() = default;
  virtual const std::string& name() const = 0;
  // The volume's next bytes. Needs: OnBytesConsumed() was called for the bytes before.
  virtual void Append(std::string bytes) = 0;
  // No more bytes follow. `expected` is the digest that the sender states, if any.
  // Needs: as Append(); called once, after the last Append().
  virtual void FinishVolume(std::optional<Sha256Digest> expected) = 0;
  // Ends the job soon, whatever it is doing, with `why` unless it has failed already; it then
  // releases its memory, threads and place. Does nothing once the job has ended; if both happen at
  // the same moment, OnEnd() tells which came first. The first of several calls counts.
  // Needs: `why` is an error.
  virtual void EndWith(absl::Status why) = 0;
  void Cancel() { EndWith(absl::CancelledError("the job was cancelled")); }
};

// Runs jobs for the handlers of calls: a JobPool, or a fake in tests.
class JobRunner {
 public:
  virtual ~JobRunner() = default;
  // Admits or refuses immediately, from the declaration; nothing is decoded yet.
  // Errors: a CallError (errors/call_error.h).
  virtual absl::StatusOr<std::shared_ptr<Job>> Start(JobRequest request,
                                                     std::shared_ptr<JobListener> listener) = 0;
  virtual absl::StatusOr<std::shared_ptr<Job>> Start(LabelsRequest request,
                                                     std::shared_ptr<LabelsListener> listener) = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_JOB_RUNNER_H_
