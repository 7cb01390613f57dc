#ifndef BCCSKEL_CORE_EXEC_MEETING_TEAM_H_
#define BCCSKEL_CORE_EXEC_MEETING_TEAM_H_

#include "core/exec/context.h"
#include "core/exec/worker_team.h"

namespace bccskel::exec {

// Workers in lockstep: they wait for each other at a barrier after each step. If that is slower
// than one worker, the others leave and worker 0 continues alone.
class MeetingTeam {
 public:
  // `size` as from Context::MeetingWorkersFor(). Needs: `context` outlives this.
  MeetingTeam(int size, const Context& context)
      : size_(size),
        context_(context),
        barrier_(size),
        patience_(1 - (1 - context.patience) * 2 / size) {}

  int size() const { return size_; }
  // Whether the team has more than one worker.
  bool meets(int worker) const { return size_ > 1 && !(worker == 0 && alone_); }

  // Runs `part(worker)` on each.
  template <typename Part>
  void Run(Part part) {
    context_.Run(size_, [&](int worker) { barrier_.Guard(worker, [&] { part(worker); }); });
    if (size_ > 1) patience_.Tell(context_.team->in_lockstep());
  }

  // The part of shared work that a worker owns.
  Share ShareOf(size_t count, int worker) const {
    return exec::ShareOf(count, worker, alone_ ? 1 : size_);
  }

  // A barrier, or its two halves as in Barrier; does nothing for one worker.
  void Meet(int worker) {
    Arrive(worker);
    Await(worker);
  }
  void Arrive(int worker) {
    if (meets(worker)) barrier_.Arrive(worker);
  }
  void Await(int worker) {
    if (!meets(worker)) return;
    const Barrier::Duration blocked = barrier_.Await(worker);
    if (worker == 0) patience_.Blocked(blocked);
  }

  // Whether this worker continues: a barrier at which the others may leave. All workers decide the
  // same; otherwise some would wait forever. False once the job must stop.
  // Needs: between two calls workers meet, so that all have read what the first one decided.
  bool GoOn(int worker) {
    if (!meets(worker)) return !context_.ShouldStop();
    if (worker == 0) stopped_ = context_.ShouldStop();
    ConsiderParting(worker);
    Meet(worker);
    if (stopped_ || (parting_ && worker != 0)) return false;
    if (parting_) GoOnAlone();
    return true;
  }

  // Decides whether the others leave, if worker 0 must take over state from them. Called by all
  // before a meeting; after that meeting parting() holds the decision of worker 0.
  void ConsiderParting(int worker) {
    if (worker != 0 || !meets(0)) return;
    parting_ = patience_.Lost() || context_.usable_threads() == 1;
  }
  // Whether the others are to leave.
  bool parting() const { return parting_; }
  // On worker 0, after the others have stored what it merges.
  void GoOnAlone() { alone_ = true; }

 private:
  const int size_;
  const Context& context_;
  Barrier barrier_;
  Patience patience_;  // worker 0's
  // Written by worker 0 before a meeting that all others reach after they have read the last value.
  bool stopped_ = false;
  bool parting_ = false;
  bool alone_ = false;  // read only by worker 0 once the others leave
};

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_MEETING_TEAM_H_
