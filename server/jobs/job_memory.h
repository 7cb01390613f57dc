#ifndef BCCSKEL_SERVER_JOBS_JOB_MEMORY_H_
#define BCCSKEL_SERVER_JOBS_JOB_MEMORY_H_

#include <algorithm>
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

// The memory of a running job: the amount admitted from its declaration and its received volume,
// and what its stages request once they know more. The admission decides about each request.
// Threads: safe.
class JobMemory final : public exec::MemoryBudget {
 public:
  // Never holds less than `min_bytes` before Close(). Needs: the ticket holds as much.
  explicit JobMemory(Ticket ticket, uint64_t min_bytes = 0)
      : min_bytes_(min_bytes), ticket_(std::move(ticket)), base_(ticket_.bytes()) {}

  // Sets the job's need apart from what its stages take. Errors: a CallError.
  absl::Status SetBase(uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    absl::Status status = ticket_.ResizeTo(AtLeast(bytes + taken_));
    if (status.ok()) base_ = bytes;
    return status;
  }

  // Errors: a CallError that names `what_for`.
  absl::Status Take(uint64_t bytes, const std::string& what_for) override {
    const std::lock_guard lock(mutex_);
    absl::Status status = ticket_.ResizeTo(AtLeast(SaturatingAdd(base_ + taken_, bytes)));
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
    ticket_.ShrinkTo(AtLeast(base_ + taken_));
  }

  // Ends the budget: the returned ticket holds the reservation.
  Ticket Close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    return std::move(ticket_);
  }

 private:
  uint64_t AtLeast(uint64_t bytes) const { return std::max(bytes, min_bytes_); }

  const uint64_t min_bytes_;
  mutable std::mutex mutex_;
  Ticket ticket_;       // guarded by mutex_, as are the members below
  uint64_t base_;       // without what stages take
  uint64_t taken_ = 0;  // by stages
  bool closed_ = false;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_JOB_MEMORY_H_
