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

std::string VerdictInWords(const Certificate& certificate) {
  if (!certificate.TopologyKept()) return "TOPOLOGY NOT KEPT";
  if (!certificate.sampled) return "topology kept";
  const std::string kept = "topology of the sampled object kept, sampling ";
  if (certificate.MaskKept()) return kept + "may have changed the mask's";
  return kept + "changed " + DescribeChanges(*certificate.mask, certificate.Given());
}

}  // namespace bccskel
