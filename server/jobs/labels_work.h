#ifndef BCCSKEL_SERVER_JOBS_LABELS_WORK_H_
#define BCCSKEL_SERVER_JOBS_LABELS_WORK_H_

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "server/jobs/job_runner.h"
#include "server/jobs/job_work.h"
#include "server/jobs/volume_receiver.h"

namespace bccskel::server {

// Counts the memory of results that were handed out and are not let go of yet.
// Threads: safe.
class UnreadResults : public std::enable_shared_from_this<UnreadResults> {
 public:
  uint64_t bytes() const { return bytes_; }

  // Counts `bytes` until what it returns is let go of; then `wake` is called.
  std::shared_ptr<void> Hold(uint64_t bytes, std::function<void()> wake) {
    bytes_ += bytes;
    return {static_cast<void*>(this),
            [all = shared_from_this(), bytes, wake = std::move(wake)](void*) {
              all->bytes_ -= bytes;
              wake();
            }};
  }

 private:
  std::atomic<uint64_t> bytes_ = 0;
};

// A volume of labels, a skeleton for each. A turn takes as many labels as fit into the memory for
// computing; their results wait in the same memory until they are let go of. So the memory is
// bounded however slowly the caller reads, and a job that waits for its caller keeps no threads.
class LabelsWork final : public JobWork {
 public:
  // `threads` that it may get at most; memory is reserved for so many.
  LabelsWork(LabelsRequest request, const VolumeLimits& limits, int threads,
             std::shared_ptr<LabelsListener> listener);

  absl::Status Append(std::string_view bytes, const exec::Context& context) override;
  absl::Status Finish(const std::optional<Sha256Digest>& expected,
                      const exec::Context& context) override;
  uint64_t BytesToRun() const override;
  int MostThreads(int threads) const override;
  uint64_t Bricks() const override { return bricks_; }
  bool MayRun() const override;
  absl::StatusOr<Turn> Run(exec::Context context, const std::shared_ptr<exec::MemoryBudget>& memory,
                           const std::function<void()>& wake) override;
  uint64_t ObjectPoints() const override { return result_.object_points; }
  void End(absl::Status status, const JobTimes& times, Ticket ticket) override;

 private:
  using Clock = exec::Context::Clock;

  void Plan();
  // Memory for computing that no result occupies.
  uint64_t Room() const;
  LabeledObjects TakeTurn();
  absl::Status Deliver(LabelSkeleton skeleton, const std::shared_ptr<exec::MemoryBudget>& memory,
                       const std::function<void()>& wake);
  void Report() const;

  const LabelsRequest request_;
  const VolumeLimits limits_;
  const int threads_;
  std::shared_ptr<LabelsListener> listener_;
  std::unique_ptr<LabelReceiver> receiver_;

  LabeledObjects labels_;
  std::vector<uint64_t> estimates_;  // bytes to compute each of labels_
  size_t next_ = 0;                  // of labels_; those before have no runs any more
  uint64_t runs_bytes_ = 0;          // of the runs that are left
  uint64_t compute_bytes_ = 0;       // for labels at work and results that are not let go of
  uint64_t bricks_ = 0;              // of all labels
  std::shared_ptr<UnreadResults> unread_ = std::make_shared<UnreadResults>();
  Clock::time_point started_;
  LabelsResult result_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_LABELS_WORK_H_
