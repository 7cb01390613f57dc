#ifndef BCCSKEL_CORE_EXEC_CONTEXT_H_
#define BCCSKEL_CORE_EXEC_CONTEXT_H_

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>

#include "absl/status/status.h"
#include "core/exec/worker_team.h"

namespace bccskel::exec {

// The progress of a running job after each shell of the object.
struct ShellProgress {
  int32_t shell = 0;       // the shell just thinned, 1..last_shell
  int32_t last_shell = 0;  // the deepest shell of the object
  uint64_t points = 0;     // candidate points that entered with this shell
  uint64_t removed = 0;    // points removed so far, all shells together
  uint64_t remaining = 0;  // points of the object still there
};

// Passed from stage to stage: the threads that a job may use, when it must stop, and who receives
// its progress. The default context has one thread, never stops and reports nothing. Threads:
// ShouldStop() and StopStatus() from any worker; Report() from worker 0 only.
class Context {
 public:
  using Clock = std::chrono::steady_clock;

  WorkerTeam* team = nullptr;  // not owned; null means one thread
  std::stop_token stop;
  Clock::time_point deadline = Clock::time_point::max();
  std::function<void(const ShellProgress&)> on_shell;
  // Called by Yield() and ShouldStop() on the calling worker; may use the thread for more urgent
  // work. Must return and not throw. Results do not depend on it.
  std::function<void()> yield = nullptr;

  // How many of its threads the job should use now, at least 1; null means all. Called where a
  // stage distributes its work, and by teams that work in lockstep: at 1, worker 0 continues alone.
  // Results do not depend on it.
  std::function<int()> share = nullptr;

  // A directional pass gives each worker at least this many bricks: with fewer, workers would spend
  // more time waiting for each other, and for bricks in each other's caches, than thinning.
  // Measured: from 1,000 bricks on, two threads were not slower on an idle machine.
  size_t min_bricks_per_worker = 512;

  // A team of two that works in lockstep shrinks to worker 0 if that worker was blocked for more
  // than this share of the time. Larger teams, which lose more by that, bear more: until two would
  // be faster.
  double patience = 0.2;

  int threads() const { return team == nullptr ? 1 : team->size(); }
  int usable_threads() const { return share ? std::min(share(), threads()) : threads(); }
  // How many workers share `bricks` bricks; at least 1, at most usable_threads(). `work` is the
  // work per brick between two barriers, relative to a directional pass.
  int WorkersFor(size_t bricks, size_t work = 1) const {
    const size_t shares = bricks * work / (min_bricks_per_worker == 0 ? 1 : min_bricks_per_worker);
    const auto most = static_cast<size_t>(usable_threads());
    return static_cast<int>(shares < 1 ? 1 : (shares < most ? shares : most));
  }

  // The same for workers that meet at barriers and so may have to wait for each other.
  int MeetingWorkersFor(size_t bricks, size_t work = 1) const {
    const int workers = WorkersFor(bricks, work);
    return workers == 1 || !team->in_lockstep().Holds() ? 1 : workers;
  }

  // Runs `work(worker)` on the first `workers` of the team; a single one does not wake the others.
  void Run(int workers, const std::function<void(int)>& work) const {
    if (workers == 1) return work(0);
    team->Run([&](int worker) {
      if (worker < workers) work(worker);
    });
  }

  // For work that any worker can do alone, such as taking Portions: of the first `workers`, those
  // that start in time take part.
  void Offer(const std::function<void(int)>& work) const { Offer(usable_threads(), work); }
  void Offer(int workers, const std::function<void(int)>& work) const {
    if (workers == 1) return work(0);
    team->Offer([&](int worker) {
      if (worker < workers) work(worker);
    });
  }

  // Distributes shares of up to `at_once` items, which together are 0..count-1, among the first
  // `workers`, in any order. A worker that gets a share calls `make_work(worker)` once, then what
  // that returned with each of its shares.
  // Errors: those of StopStatus(); shares are then missing.
  template <typename MakeWork>
  absl::Status ForEachShare(int workers, size_t count, size_t at_once, MakeWork make_work) const {
    Portions portions(count, at_once);
    Offer(workers, [&](int worker) {
      Share mine = portions.Take();
      if (mine.begin == mine.end || ShouldStop()) return;
      auto work = make_work(worker);
      for (; mine.begin < mine.end && !ShouldStop(); mine = portions.Take()) work(mine);
    });
    return StopStatus();
  }
  // The same on all usable threads, with one `work` for all of them.
  template <typename Work>
  absl::Status ForEachShare(size_t count, size_t at_once, Work work) const {
    return ForEachShare(usable_threads(), count, at_once, [&](int) { return std::ref(work); });
  }
  // The same item by item: what `make_work(worker)` returned is called with each item of a share.
  template <typename MakeWork>
  absl::Status ForEach(int workers, size_t count, size_t at_once, MakeWork make_work) const {
    return ForEachShare(workers, count, at_once, [&](int worker) {
      return [work = make_work(worker)](Share mine) mutable {
        for (size_t n = mine.begin; n < mine.end; ++n) work(n);
      };
    });
  }

  // Offers this thread to more urgent work. Called where ShouldStop() is not called for more than
  // about a millisecond.
  void Yield() const {
    if (yield) yield();
  }

  // True when the job was cancelled or its deadline has passed. Asked once per direction pass and
  // at least every 20 ms of work in every stage, never per point.
  bool ShouldStop() const {
    Yield();
    return stop.stop_requested() ||
           (deadline != Clock::time_point::max() && Clock::now() >= deadline);
  }

  // OK, CANCELLED or DEADLINE_EXCEEDED.
  absl::Status StopStatus() const {
    if (!ShouldStop()) return absl::OkStatus();
    if (stop.stop_requested()) return absl::CancelledError("the job was cancelled");
    return absl::DeadlineExceededError("the job's deadline has passed");
  }

  void Report(const ShellProgress& progress) const {
    if (on_shell) on_shell(progress);
  }
};

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_CONTEXT_H_
