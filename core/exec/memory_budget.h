#ifndef BCCSKEL_CORE_EXEC_MEMORY_BUDGET_H_
#define BCCSKEL_CORE_EXEC_MEMORY_BUDGET_H_

#include <atomic>
#include <cstdint>
#include <limits>
#include <string>

#include "absl/status/status.h"

namespace bccskel::exec {

// The memory that a job may use. Stages whose need does not follow from the number of bricks
// reserve a stated number of bytes per item before they allocate. Threads: safe.
class MemoryBudget {
 public:
  virtual ~MemoryBudget() = default;
  // `what_for` is for messages: "1234 skeleton points".
  // Errors: RESOURCE_EXHAUSTED if it exceeds the limit, UNAVAILABLE if other jobs hold it now.
  virtual absl::Status Take(uint64_t bytes, const std::string& what_for) = 0;
  virtual void GiveBack(uint64_t bytes) = 0;

  absl::Status TakeFor(uint64_t items, uint64_t bytes_each, const char* name) {
    constexpr uint64_t kMost = std::numeric_limits<uint64_t>::max();
    const uint64_t bytes = items > kMost / bytes_each ? kMost : items * bytes_each;
    return Take(bytes, std::to_string(items) + " " + name);
  }
};

// Without a limit.
class UnlimitedMemory final : public MemoryBudget {
 public:
  absl::Status Take(uint64_t, const std::string&) override { return absl::OkStatus(); }
  void GiveBack(uint64_t) override {}
};

// A part of a budget. Its destructor returns everything, unless it was told to keep it. Needs:
// `whole` outlives it.
class MemoryShare final : public MemoryBudget {
 public:
  explicit MemoryShare(MemoryBudget& whole) : whole_(whole) {}
  ~MemoryShare() override { whole_.GiveBack(taken_); }
  MemoryShare(const MemoryShare&) = delete;
  MemoryShare& operator=(const MemoryShare&) = delete;

  absl::Status Take(uint64_t bytes, const std::string& what_for) override {
    absl::Status status = whole_.Take(bytes, what_for);
    if (status.ok()) taken_ += bytes;
    return status;
  }
  void GiveBack(uint64_t bytes) override {
    taken_ -= bytes;
    whole_.GiveBack(bytes);
  }
  // Transfers what was taken to `whole`.
  void Keep() { taken_ = 0; }

 private:
  MemoryBudget& whole_;
  std::atomic<uint64_t> taken_ = 0;
};

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_MEMORY_BUDGET_H_
