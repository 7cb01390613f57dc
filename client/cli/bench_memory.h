#ifndef BCCSKEL_CLIENT_CLI_BENCH_MEMORY_H_
#define BCCSKEL_CLIENT_CLI_BENCH_MEMORY_H_

#include <cstdint>
#include <optional>

namespace bccskel::cli {

// By how much the resident memory of this process has grown at its highest, from construction on.
// Construction gives memory that was freed, but not returned, back to the system first, so that its
// reuse counts. Linux only: VmRSS and VmHWM, which are right within about 0.5 MB.
class PeakGrowth {
 public:
  PeakGrowth();

  // Nothing where the system does not let a process reset its high-water mark.
  std::optional<uint64_t> bytes() const;

 private:
  std::optional<uint64_t> before_;
};

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_BENCH_MEMORY_H_
