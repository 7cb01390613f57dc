#ifndef BCCSKEL_CORE_PIPELINE_PRESETS_H_
#define BCCSKEL_CORE_PIPELINE_PRESETS_H_

#include <span>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel {

// Options for a kind of data. Other options stay unchanged.
struct Preset {
  const char* name;
  const char* data;  // what it is for
  PreparingOptions preparing;
  double pruning_threshold = 0;  // 0: the default
};

std::span<const Preset> Presets();

// Errors: INVALID_ARGUMENT for an unknown name; the message lists the known ones.
absl::Status ApplyPreset(std::string_view name, SkeletonizeOptions& options);

// The options that the preset sets, as on the command line: "--fill-cavities --min-component 100".
std::string OptionsOf(const Preset& preset);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_PRESETS_H_
