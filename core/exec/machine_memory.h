#ifndef BCCSKEL_CORE_EXEC_MACHINE_MEMORY_H_
#define BCCSKEL_CORE_EXEC_MACHINE_MEMORY_H_

#include <atomic>
#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "core/exec/memory_budget.h"

namespace bccskel::exec {

// The memory that this process may use, in bytes: that of the machine, or the smallest limit of its
// control groups and their ancestors, v1 and v2. 4 GiB if nothing can be read. `root` is the folder
// that contains proc and sys.
uint64_t AvailableMemoryBytes(const std::string& root = "");

// The budget of a job that has the machine to itself. Without it, an object of noise, whose
// skeleton has more points than the object, would make the kernel kill some process.
class MachineMemory final : public MemoryBudget {
 public:
  explicit MachineMemory(uint64_t limit = AvailableMemoryBytes()) : limit_(limit) {}
  absl::Status Take(uint64_t bytes, const std::string& what_for) override;
  void GiveBack(uint64_t bytes) override { taken_ -= bytes; }

 private:
  const uint64_t limit_;
  std::atomic<uint64_t> taken_ = 0;
};

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_MACHINE_MEMORY_H_
