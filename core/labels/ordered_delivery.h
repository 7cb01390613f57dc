#ifndef BCCSKEL_CORE_LABELS_ORDERED_DELIVERY_H_
#define BCCSKEL_CORE_LABELS_ORDERED_DELIVERY_H_

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "core/labels/skeletonize_labels.h"

namespace bccskel {

// Delivers results that are computed in any order to a consumer in order, from one thread at a
// time. Threads: all members from any thread.
class OrderedDelivery {
 public:
  // At most `window` results wait for one that comes before them.
  OrderedDelivery(const LabelConsumer& consume, size_t window)
      : consume_(consume), window_(window) {}

  // Waits until result `index` may be made. False when the work is over for good.
  bool WaitForTurn(size_t index, const exec::Context& context);
  // Takes a result; hands on all that are next in order unless another thread is doing so.
  void Add(size_t index, LabelSkeleton&& skeleton);
  // Ends the work; the first failure counts.
  void Fail(const absl::Status& status);

  absl::Status status() const;

 private:
  void HandOn(std::unique_lock<std::mutex>& lock);

  const LabelConsumer& consume_;
  const size_t window_;
  mutable std::mutex mutex_;
  std::condition_variable moved_;
  std::map<size_t, LabelSkeleton> waiting_;  // guarded by mutex_, as are all below
  size_t next_ = 0;
  enum class Handing { kIdle, kBusy } handing_ = Handing::kIdle;
  absl::Status status_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LABELS_ORDERED_DELIVERY_H_
