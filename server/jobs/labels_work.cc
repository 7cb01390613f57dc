#include "server/jobs/labels_work.h"

#include <algorithm>
#include <utility>

#include "core/exec/status_macros.h"
#include "core/labels/skeletonize_labels_within.h"
#include "server/admission/memory_estimate.h"

namespace bccskel::server {
namespace {

// So many labels of the largest size for each thread that threads seldom wait for the last label of
// a turn.
constexpr uint64_t kLabelsPerThread = 8;

// Of a result beside its graph.
constexpr uint64_t kResultBytes = 1024;

}  // namespace

LabelsWork::LabelsWork(LabelsRequest request, const VolumeLimits& limits, int threads,
                       std::shared_ptr<LabelsListener> listener)
    : request_(std::move(request)),
      limits_(limits),
      threads_(threads),
      listener_(std::move(listener)),
      receiver_(std::make_unique<LabelReceiver>(request_)) {}

absl::Status LabelsWork::Append(std::string_view bytes, const exec::Context& context) {
  return receiver_->Append(bytes, context);
}

absl::Status LabelsWork::Finish(const std::optional<Sha256Digest>& expected,
                                const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(CollectedLabels collected, receiver_->Finish(expected, context));
  receiver_.reset();
  labels_ = std::move(collected.objects);
  result_.skipped = collected.skipped;
  result_.absent = collected.absent;
  Plan();
  return absl::OkStatus();
}

void LabelsWork::Plan() {
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

uint64_t LabelsWork::BytesToRun() const { return kFixedJobBytes + runs_bytes_ + compute_bytes_; }

int LabelsWork::MostThreads(int threads) const {
  return ThreadsFor(bricks_, request_.threads_wanted, threads);
}

uint64_t LabelsWork::Room() const {
  return compute_bytes_ - std::min(compute_bytes_, unread_->bytes());
}

bool LabelsWork::MayRun() const {
  return next_ == labels_.objects.size() || unread_->bytes() == 0 || estimates_[next_] <= Room();
}

LabeledObjects LabelsWork::TakeTurn() {
  LabeledObjects turn = {labels_.grid, {}};
  uint64_t room = std::max(Room(), estimates_[next_]);
  for (; next_ < estimates_.size() && estimates_[next_] <= room; ++next_) {
    room -= estimates_[next_];
    turn.objects.push_back(std::move(labels_.objects[next_]));
  }
  return turn;
}

absl::StatusOr<JobWork::Turn> LabelsWork::Run(exec::Context context,
                                              const std::shared_ptr<exec::MemoryBudget>& memory,
                                              const std::function<void()>& wake) {
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

// A graph that takes more than was reserved for its label takes the rest of the budget, until it is
// let go of.
absl::Status LabelsWork::Deliver(LabelSkeleton skeleton,
                                 const std::shared_ptr<exec::MemoryBudget>& memory,
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

void LabelsWork::Report() const {
  listener_->OnProgress(result_.labels, estimates_.size(), Clock::now() - started_);
}

void LabelsWork::End(absl::Status status, const JobTimes& times, Ticket ticket) {
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

}  // namespace bccskel::server
