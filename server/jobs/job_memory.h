#ifndef BCCSKEL_SERVER_JOBS_JOB_MEMORY_H_
#define BCCSKEL_SERVER_JOBS_JOB_MEMORY_H_

#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "core/exec/memory_budget.h"
#include "server/admission/admission.h"
#include "server/admission/memory_estimate.h"
#include "server/errors/call_error.h"

namespace bccskel::server {

// The memory of a running job: what was admitted for it from what it declared and received, and
// what its stages ask for when they know more. The admission decides about each part.
// Threads: safe.
class JobMemory final : public exec::MemoryBudget {
 public:
  explicit JobMemory(Ticket ticket) : ticket_(std::move(ticket)), base_(ticket_.bytes()) {}

  // What the job needs besides what its stages took. Errors: a CallError.
  absl::Status SetBase(uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    absl::Status status = ticket_.ResizeTo(bytes + taken_);
    if (status.ok()) base_ = bytes;
    return status;
  }

  // Errors: a CallError, which says what for.
  absl::Status Take(uint64_t bytes, const std::string& what_for) override {
    const std::lock_guard lock(mutex_);
    absl::Status status = ticket_.ResizeTo(SaturatingAdd(base_ + taken_, bytes));
    if (status.ok()) {
      taken_ += bytes;
      return status;
    }
    return Prefixed(what_for, status);
  }

  void GiveBack(uint64_t bytes) override {
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    taken_ -= bytes;
    ticket_.ShrinkTo(base_ + taken_);
  }

  // Ends the budget: what is reserved is the ticket's from now on.
  Ticket Close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    return std::move(ticket_);
  }

 private:
  mutable std::mutex mutex_;
  Ticket ticket_;       // guarded by mutex_, as are all below
  uint64_t base_;       // without what stages took
  uint64_t taken_ = 0;  // by stages
  bool closed_ = false;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_JOB_MEMORY_H_
