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
  const bool prepared = certificate.Given() != certificate.input;
  std::string changes;
  if (!certificate.MaskKept()) {
    changes = ", sampling changed " + DescribeChanges(*certificate.mask, certificate.Given());
  } else if (certificate.sampled) {
    changes = ", sampling may have changed the mask's";
  }
  if (prepared) {
    changes += ", preparing changed " + DescribeChanges(certificate.Given(), certificate.input);
  }
  if (changes.empty()) return "topology kept";
  return std::string("topology of the ") + (prepared ? "prepared" : "sampled") + " object kept" +
         changes;
}

}  // namespace bccskel
