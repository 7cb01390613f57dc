#include "core/exec/machine_memory.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"

namespace bccskel::exec {
namespace {

constexpr uint64_t kNone = UINT64_MAX;

uint64_t PhysicalMemoryBytes() {
  const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
  constexpr uint64_t kUnknown = uint64_t{4} << 30;
  return pages > 0 && page_bytes > 0
             ? static_cast<uint64_t>(pages) * static_cast<uint64_t>(page_bytes)
             : kUnknown;
}

// The limit in a file; kNone for "max" or if there is no such file.
uint64_t LimitIn(const std::string& path) {
  std::string text;
  std::ifstream(path) >> text;
  uint64_t bytes = 0;
  return absl::SimpleAtoi(text, &bytes) && bytes > 0 ? bytes : kNone;
}

// The smallest limit of a group like "/a/b" and its ancestors. In a container its own group may be
// the topmost one that is visible, whatever its name is outside.
uint64_t LeastLimit(const std::string& mount, std::string group, const std::string& file) {
  uint64_t least = LimitIn(absl::StrCat(mount, "/", file));
  for (; group.size() > 1; group.resize(group.rfind('/'))) {
    least = std::min(least, LimitIn(absl::StrCat(mount, group, "/", file)));
  }
  return least;
}

}  // namespace

uint64_t AvailableMemoryBytes(const std::string& root) {
  uint64_t least = PhysicalMemoryBytes();
  const std::string mount = root + "/sys/fs/cgroup";
  std::ifstream groups(root + "/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {  // like "0::/a/b" or "9:cpu,memory:/a/b"
    const std::vector<std::string> parts = absl::StrSplit(line, absl::MaxSplits(':', 2));
    if (parts.size() != 3 || !absl::StartsWith(parts[2], "/")) continue;
    const std::vector<std::string> controllers = absl::StrSplit(parts[1], ',');
    if (parts[1].empty()) {
      least = std::min(least, LeastLimit(mount, parts[2], "memory.max"));
    } else if (std::ranges::find(controllers, "memory") != controllers.end()) {
      least = std::min(least, LeastLimit(mount + "/memory", parts[2], "memory.limit_in_bytes"));
    }
  }
  return least;
}

absl::Status MachineMemory::Take(uint64_t bytes, const std::string& what_for) {
  uint64_t taken = taken_;
  do {
    if (bytes > limit_ || taken > limit_ - bytes) {
      return absl::ResourceExhaustedError(
          absl::StrFormat("%s: they need up to %d bytes of memory, and %d are reserved already; "
                          "this machine has %d; "
                          "use an object with fewer parts, such as a denoised or coarser one",
                          what_for, bytes, taken, limit_));
    }
  } while (!taken_.compare_exchange_weak(taken, taken + bytes));
  return absl::OkStatus();
}

}  // namespace bccskel::exec
