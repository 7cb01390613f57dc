#include "core/labels/ordered_delivery.h"

#include <chrono>
#include <utility>

namespace bccskel {

bool OrderedDelivery::WaitForTurn(size_t index, const exec::Context& context) {
  constexpr auto kBetweenChecks = std::chrono::milliseconds(10);
  std::unique_lock lock(mutex_);
  while (status_.ok() && index >= next_ + window_ && !context.ShouldStop()) {
    moved_.wait_for(lock, kBetweenChecks);
  }
  if (status_.ok()) status_ = context.StopStatus();
  return status_.ok();
}

void OrderedDelivery::Add(size_t index, LabelSkeleton&& skeleton) {
  std::unique_lock lock(mutex_);
  waiting_.emplace(index, std::move(skeleton));
  if (handing_ == Handing::kIdle) HandOn(lock);
}

void OrderedDelivery::HandOn(std::unique_lock<std::mutex>& lock) {
  handing_ = Handing::kBusy;
  while (status_.ok() && !waiting_.empty() && waiting_.begin()->first == next_) {
    LabelSkeleton skeleton = std::move(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
    lock.unlock();
    absl::Status consumed = consume_(std::move(skeleton));
    lock.lock();
    if (status_.ok()) status_ = std::move(consumed);
    ++next_;
    moved_.notify_all();
  }
  handing_ = Handing::kIdle;
}

void OrderedDelivery::Fail(const absl::Status& status) {
  const std::lock_guard lock(mutex_);
  if (status_.ok()) status_ = status;
  moved_.notify_all();
}

absl::Status OrderedDelivery::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

}  // namespace bccskel
