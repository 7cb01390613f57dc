#include "core/pipeline/option_words.h"

#include <charconv>

#include "absl/strings/str_join.h"

namespace bccskel {
namespace {

// The shortest text that reads back to the same value.
template <typename Number>
OptionFact NumberFact(const char* name, Number value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {name, std::string(digits.data(), end), OptionFact::Type::kNumber};
}

}  // namespace

std::vector<OptionFact> FactsOf(const SkeletonizeOptions& options) {
  const ThinningOptions& thinning = options.thinning;
  const PreparingOptions& preparing = options.preparing;
  const bool fills = preparing.cavities == CavityFilling::kOn;
  const bool one = preparing.components == KeptComponents::kLargest;
  return {NumberFact("denoise_passes", preparing.denoise_passes),
          {"cavities", fills ? "filled" : "kept"},
          NumberFact("tunnel_width", preparing.tunnel_width),
          NumberFact("tunnel_cells", preparing.tunnel_cells),
          NumberFact("join_gaps", preparing.join_gaps),
          NumberFact("min_component_points", preparing.min_component_points),
          NumberFact("min_component_volume", preparing.min_component_volume),
          {"components", one ? "largest" : "all"},
          {"thinning", WordFor(kMethodWords, thinning.method)},
          {"kind", WordFor(kKindWords, thinning.kind)},
          {"distance", WordFor(kDistanceWords, options.distance)},
          {"stubble", WordFor(kStubbleWords, thinning.stubble)},
          {"cleanup", thinning.cleanup == ThinnessCleanup::kOn ? "on" : "off"},
          NumberFact("shell_width", thinning.shell_width),
          NumberFact("last_shell", thinning.last_shell),
          {"pruning", WordFor(kPruningWords, options.pruning.rule)},
          NumberFact("pruning_threshold", options.pruning.threshold),
          {"tips", WordFor(kTipsWords, options.pruning.tips)},
          {"source", WordFor(kSourceWords, options.source)},
          {"voxel_slabs", absl::StrJoin(options.voxel_slabs, ",")},
          NumberFact("merge_junctions", options.junction_reach),
          {"border", WordFor(kBorderWords, options.border)}};
}

}  // namespace bccskel
