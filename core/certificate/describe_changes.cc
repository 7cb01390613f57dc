#include "core/certificate/describe_changes.h"

#include "absl/strings/str_format.h"

namespace bccskel {

std::string DescribeChanges(const BettiNumbers& before, const BettiNumbers& after) {
  std::string changes;
  const auto add = [&](const char* name, int64_t from, int64_t to) {
    if (from == to) return;
    changes += absl::StrFormat("%s%s %d -> %d", changes.empty() ? "" : ", ", name, from, to);
  };
  add("components", before.components, after.components);
  add("loops", before.loops, after.loops);
  add("cavities", before.cavities, after.cavities);
  return changes;
}

}  // namespace bccskel
