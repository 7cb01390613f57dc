#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include "core/exec/status_macros.h"
#include "core/labels/skeletonize_labels_within.h"
#include "server/admission/memory_estimate.h"
#include "server/jobs/job_work.h"

namespace bccskel::server {
namespace {

// Labels of the largest size per thread: enough that threads seldom wait for the last label of a
// turn.
constexpr uint64_t kLabelsPerThread = 8;

// Memory of a result in addition to its graph.
constexpr uint64_t kResultBytes = 1024;

// Counts the memory of delivered results that are not released yet.
// Threads: safe.
class UnreadResults : public std::enable_shared_from_this<UnreadResults> {
 public:
  uint64_t bytes() const { return bytes_; }

  // Counts `bytes` until the returned handle is released; then calls `wake`.
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

// Computes a skeleton for each label of a volume. A turn takes as many labels as fit into the
// memory for computing; their results wait in the same memory until they are released. So the
// memory is bounded however slowly the caller reads, and a job that waits for its caller keeps no
// threads.
class LabelsWork final : public JobWork {
 public:
  // `threads` is the most that it may get; memory is reserved for that many.
  LabelsWork(LabelsRequest request, const VolumeLimits& limits, int threads,
             std::shared_ptr<LabelsListener> listener)
      : request_(std::move(request)),
        limits_(limits),
        threads_(threads),
        listener_(std::move(listener)),
        receiver_(std::make_unique<LabelReceiver>(request_)) {}

  absl::Status Append(std::string_view bytes, const exec::Context& context) override {
    return receiver_->Append(bytes, context);
  }
  absl::Status Finish(const std::optional<Sha256Digest>& expected,
                      const exec::Context& context) override {
    BCCSKEL_ASSIGN_OR_RETURN(CollectedLabels collected, receiver_->Finish(expected, context));
    receiver_.reset();
    labels_ = std::move(collected.objects);
    result_.skipped = collected.skipped;
    result_.absent = collected.absent;
    Plan();
    return absl::OkStatus();
  }
  uint64_t BytesToRun() const override { return kFixedJobBytes + runs_bytes_ + compute_bytes_; }
  int MostThreads(int threads) const override {
    return ThreadsFor(bricks_, request_.threads_wanted, threads);
  }
  uint64_t Bricks() const override { return bricks_; }
  bool MayRun() const override {
    return next_ == labels_.objects.size() || unread_->bytes() == 0 || estimates_[next_] <= Room();
  }
  absl::StatusOr<JobWork::Turn> Run(exec::Context context,
                                    const std::shared_ptr<exec::MemoryBudget>& memory,
                                    const std::function<void()>& wake) override {
    if (next_ == 0) started_ = Clock::now();
    result_.threads = std::max(result_.threads, context.threads());
    if (next_ == 0) Report();
    if (next_ == estimates_.size()) return Turn::kDone;
    const LabeledObjects turn = TakeTurn();
    uint64_t turn_bytes = 0;
    for (const LabeledObject& object : turn.objects) turn_bytes += BytesOf(object);
    const LabelsOptions options = {.mask = {.adjacency = request_.header.adjacency,
                                            .points = request_.header.points,
                                            .max_bricks = limits_.max_bricks},
                                   .skeleton = request_.options};
    BCCSKEL_RETURN_IF_ERROR(SkeletonizeLabelsWithin(
        *memory, turn, options,
        [&](LabelSkeleton&& skeleton) { return Deliver(std::move(skeleton), memory, wake); },
        context));
    runs_bytes_ -= turn_bytes;
    return next_ == estimates_.size() ? Turn::kDone : Turn::kMore;
  }
  uint64_t ObjectPoints() const override { return result_.object_points; }
  void End(absl::Status status, const JobTimes& times, Ticket ticket) override {
    const std::shared_ptr<LabelsListener> listener = std::move(listener_);
    receiver_.reset();
    labels_ = {};
    if (!status.ok()) {
      ticket = Ticket();
      return listener->OnEnd(std::move(status));
    }
    ticket.LeavePlace();
    ticket.ShrinkTo(unread_->bytes());
    LabelsResult result = std::exchange(result_, LabelsResult());
    result.times = times;
    result.ticket = std::move(ticket);
    listener->OnEnd(std::move(result));
  }

 private:
  using Clock = exec::Context::Clock;

  void Plan() {
    const VoxelParts parts = PartsOf(request_.header.grid, request_.header.points);
    uint64_t all = 0, largest = 0;
    for (const LabeledObject& object : labels_.objects) {
      const uint64_t bricks = MostBricksOf(object, parts, request_.options.preparing.cavities);
      const uint64_t estimate = BytesToComputeLabel(bricks);
      estimates_.push_back(estimate);
      bricks_ += bricks;
      runs_bytes_ += BytesOf(object);
      all = SaturatingAdd(all, estimate);
      largest = std::max(largest, estimate);
    }
    const uint64_t roomy =
        SaturatingMultiply(largest, kLabelsPerThread * static_cast<uint64_t>(threads_));
    const uint64_t reserved = BytesToComputeLabels(request_.header, threads_);
    compute_bytes_ = std::max(largest, std::min({all, roomy, reserved}));
  }
  // Memory for computing that no result occupies.
  uint64_t Room() const { return compute_bytes_ - std::min(compute_bytes_, unread_->bytes()); }
  LabeledObjects TakeTurn() {
    LabeledObjects turn = {labels_.grid, {}};
    uint64_t room = std::max(Room(), estimates_[next_]);
    for (; next_ < estimates_.size() && estimates_[next_] <= room; ++next_) {
      room -= estimates_[next_];
      turn.objects.push_back(std::move(labels_.objects[next_]));
    }
    return turn;
  }
  // A graph that exceeds its label's reservation takes the excess from the budget until it is
  // released.
  absl::Status Deliver(LabelSkeleton skeleton, const std::shared_ptr<exec::MemoryBudget>& memory,
                       const std::function<void()>& wake) {
    skeleton.result.thin = Volume();
    const uint64_t bytes = kResultBytes + GraphBytes(skeleton.result.graph);
    const uint64_t excess = bytes - std::min(bytes, estimates_[result_.labels]);
    BCCSKEL_RETURN_IF_ERROR(memory->Take(excess, "results that are not read yet"));
    ++result_.labels;
    result_.voxels += skeleton.voxels;
    result_.object_points += skeleton.result.object_points;
    result_.skeleton_points += skeleton.result.skeleton_points;
    listener_->OnLabel({.skeleton = std::move(skeleton),
                        .threads = result_.threads,
                        .memory = unread_->Hold(bytes, [memory, excess, wake] {
                          memory->GiveBack(excess);
                          wake();
                        })});
    Report();
    return absl::OkStatus();
  }
  void Report() const {
    listener_->OnProgress(result_.labels, estimates_.size(), Clock::now() - started_);
  }

  const LabelsRequest request_;
  const VolumeLimits limits_;
  const int threads_;
  std::shared_ptr<LabelsListener> listener_;
  std::unique_ptr<LabelReceiver> receiver_;

  LabeledObjects labels_;
  std::vector<uint64_t> estimates_;  // bytes to compute each of labels_
  size_t next_ = 0;                  // index in labels_; the runs of those before are freed
  uint64_t runs_bytes_ = 0;          // of the remaining runs
  uint64_t compute_bytes_ = 0;       // for running labels and unreleased results
  uint64_t bricks_ = 0;              // of all labels
  std::shared_ptr<UnreadResults> unread_ = std::make_shared<UnreadResults>();
  Clock::time_point started_;
  LabelsResult result_;
};

}  // namespace

std::unique_ptr<JobWork> MakeLabelsWork(LabelsRequest request, const VolumeLimits& limits,
                                        int threads, std::shared_ptr<LabelsListener> listener) {
  return std::make_unique<LabelsWork>(std::move(request), limits, threads, std::move(listener));
}

}  // namespace bccskel::server
