#ifndef BCCSKEL_TESTS_SERVER_DURABLE_FAKE_RUNNER_H_
#define BCCSKEL_TESTS_SERVER_DURABLE_FAKE_RUNNER_H_

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "server/durable/job_codec.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// "<size>" or "<size> <anything>" declares so many bytes; with options "large", many bricks. A
// result is what the volume's bytes say, in three records, and a summary.
class FakeCodec final : public JobCodec {
 public:
  absl::StatusOr<JobRequest> RequestOf(const std::string& declaration,
                                       const std::string& options) const override;
  absl::Status WriteResult(const JobResult& result, const RecordSink& sink) const override;
};

// Computes on one thread, in no time. Of the bytes, what stands before the first '|' is the volume,
// and the rest is how it was encoded. Bytes with a '!' are malformed.
class FakeRunner final : public JobRunner {
 public:
  FakeRunner();
  ~FakeRunner() override;

  absl::StatusOr<std::shared_ptr<Job>> Start(JobRequest request,
                                             std::shared_ptr<JobListener> listener) override;
  absl::StatusOr<std::shared_ptr<Job>> Start(LabelsRequest request,
                                             std::shared_ptr<LabelsListener> listener) override;

  // Held jobs stay at work after their volume was decoded and three shells were told.
  void Hold();
  void Release();
  // Nothing that is appended counts as decoded.
  void HoldDecoding();
  // Start() refuses; an OK status lets jobs in again.
  void Refuse(absl::Status status);
  // Jobs need so many bytes and end for lack of them, and no job may begin that asks for them; 0
  // lets all have their memory again.
  void RunShort(uint64_t needed_bytes);
  // Until so many jobs have begun to compute since the start, or were cancelled before.
  void WaitForComputing(int jobs);
  int started() const;
  int computed() const;        // to the end
  uint64_t min_bytes() const;  // of the last job that began

 private:
  friend class FakeJob;
  void Serve(std::stop_token stop);

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::vector<std::function<void()>> tasks_;   // guarded by mutex_
  bool held_ = false;                          // guarded by mutex_
  bool decoding_held_ = false;                 // guarded by mutex_
  absl::Status refusal_;                       // guarded by mutex_
  uint64_t needed_bytes_ = 0, min_bytes_ = 0;  // guarded by mutex_
  int started_ = 0, computing_ = 0, computed_ = 0;
  std::vector<std::function<void()>> waiting_;  // guarded by mutex_: ends of held jobs
  std::jthread thread_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_TESTS_SERVER_DURABLE_FAKE_RUNNER_H_
