#include "core/pipeline/presets.h"

#include <algorithm>
#include <array>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace bccskel {
namespace {

// Sizes are in voxels, since the flaws of a scan have its resolution. tests/quality/report.md shows
// the effect of each preset on real masks.
constexpr uint64_t kSpeckPoints = 200;  // of an object without voxels
constexpr int kSpeckVoxels = 70;        // about as many; see ComponentSize
constexpr std::array kPresets = {
    Preset{"neuron",
           "traced or segmented neurons: removes cavities, small tunnels and specks",
           {.cavities = CavityFilling::kOn,
            .min_component_points = kSpeckPoints,
            .component_size = ComponentSize::kVoxels,
            .tunnel_cells = 4}},
    Preset{"vessels",
           "blood vessels: removes cavities, pinholes and specks; keeps rings of vessels",
           {.cavities = CavityFilling::kOn,
            .min_component_points = kSpeckPoints,
            .component_size = ComponentSize::kVoxels,
            .tunnel_cells = 2}},
    Preset{"airway",
           "one tree of airways or ducts: removes cavities, small tunnels and all but the tree",
           {.cavities = CavityFilling::kOn,
            .components = KeptComponents::kLargest,
            .tunnel_cells = 4}},
    Preset{"materials",
           "fibers, foams and pores: removes cavities and specks; keeps all tunnels",
           {.cavities = CavityFilling::kOn,
            .min_component_points = kSpeckPoints,
            .component_size = ComponentSize::kVoxels}},
    Preset{"cad", "machine parts: chamfers, fillets and corners get no branch", {}, 0.8},
};

}  // namespace

std::span<const Preset> Presets() { return kPresets; }

absl::Status ApplyPreset(std::string_view name, SkeletonizeOptions& options) {
  const auto preset = std::ranges::find(kPresets, name, &Preset::name);
  if (preset == kPresets.end()) {
    const auto add_name = [](std::string* out, const Preset& p) { out->append(p.name); };
    return absl::InvalidArgumentError(absl::StrCat("preset ", std::string(name),
                                                   ": must be one of ",
                                                   absl::StrJoin(kPresets, ", ", add_name)));
  }
  const uint64_t max_bricks = options.preparing.max_bricks;
  options.preparing = preset->preparing;
  options.preparing.max_bricks = max_bricks;
  if (preset->pruning_threshold > 0) options.pruning.threshold = preset->pruning_threshold;
  return absl::OkStatus();
}

std::string OptionsOf(const Preset& preset) {
  const PreparingOptions& preparing = preset.preparing;
  std::vector<std::string> words;
  if (preparing.cavities == CavityFilling::kOn) words.push_back("--fill-cavities");
  if (preparing.min_component_points > 0) {
    words.push_back(absl::StrCat("--min-component for ", kSpeckVoxels, " voxels"));
  }
  if (preparing.components == KeptComponents::kLargest) words.push_back("--keep-largest");
  if (preparing.tunnel_cells > 0) {
    words.push_back(absl::StrCat("--cut-loops for ", preparing.tunnel_cells, " voxels"));
  }
  if (preset.pruning_threshold > 0) {
    words.push_back(absl::StrCat("--pruning-threshold ", preset.pruning_threshold));
  }
  return absl::StrJoin(words, " ");
}

}  // namespace bccskel
