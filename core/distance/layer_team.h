#ifndef BCCSKEL_CORE_DISTANCE_LAYER_TEAM_H_
#define BCCSKEL_CORE_DISTANCE_LAYER_TEAM_H_

#include "core/exec/context.h"
#include "core/exec/worker_team.h"

namespace bccskel {

// Workers that go from layer to layer together. Shrinks to worker 0 where that is faster.
class LayerTeam {
 public:
  LayerTeam(int size, const exec::Context& context)
      : size_(size), context_(context), barrier_(size), patience_(context.patience) {}

  // Runs `part(worker)` on each.
  template <typename Part>
  void Run(Part part) {
    context_.Run(size_, [&](int worker) { barrier_.Guard([&] { part(worker); }); });
    if (size_ > 1) patience_.Tell(context_.team->confidence());
  }

  // What a worker does of a layer that all share.
  exec::Share ShareOf(size_t count, int worker) const {
    return exec::ShareOf(count, worker, alone_ ? 1 : size_);
  }

  void Meet(int worker) {
    if (size_ == 1 || alone_) return;
    const exec::Barrier::Duration blocked = barrier_.Wait(worker);
    if (worker == 0) patience_.Blocked(blocked);
  }

  // Whether this worker goes on to the next slab. All decide the same, or some would wait for
  // others for ever.
  bool GoOn(int worker) {
    if (size_ == 1 || alone_) return !context_.ShouldStop();
    if (worker == 0) {
      stopped_ = context_.ShouldStop();
      leave_ = patience_.Lost() || context_.usable_threads() == 1;
    }
    Meet(worker);
    if (stopped_ || (leave_ && worker != 0)) return false;
    if (leave_) alone_ = true;
    return true;
  }

 private:
  const int size_;
  const exec::Context& context_;
  exec::Barrier barrier_;
  exec::Patience patience_;  // worker 0's
  // Written by worker 0 before a meeting that all others reach after they have read the last value.
  bool stopped_ = false;
  bool leave_ = false;
  bool alone_ = false;  // read by worker 0 only once the others leave
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_LAYER_TEAM_H_
