#include "client/cli/bench_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace bccskel::cli {
namespace {

// A line "VmRSS:   1234 kB" of /proc/self/status, in bytes.
std::optional<uint64_t> ProcessBytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    uint64_t kilobytes = 0;
    if (word == key && status >> kilobytes) return kilobytes * 1024;
  }
  return std::nullopt;
}

bool ResetHighWaterMark() {
  std::ofstream references("/proc/self/clear_refs");
  references << "5" << std::flush;  // see proc(5)
  return references.good();
}

}  // namespace

PeakGrowth::PeakGrowth() {
  malloc_trim(0);
  if (ResetHighWaterMark()) before_ = ProcessBytes("VmRSS:");
}

std::optional<uint64_t> PeakGrowth::bytes() const {
  const std::optional<uint64_t> peak = ProcessBytes("VmHWM:");
  if (!before_.has_value() || !peak.has_value()) return std::nullopt;
  return *peak > *before_ ? *peak - *before_ : 0;
}

}  // namespace bccskel::cli
