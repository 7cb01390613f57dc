#ifndef BCCSKEL_CLIENT_CLI_THINNING_OPTIONS_H_
#define BCCSKEL_CLIENT_CLI_THINNING_OPTIONS_H_

#include <optional>
#include <string>

#include "absl/status/status.h"
#include "client/cli/arguments.h"
#include "client/export/point_forest.h"
#include "core/pipeline/skeletonize.h"
#include "core/skeleton/tree_order.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Adds the options for preparing an object, thinning, pruning and the roots of trees; and their
// presets, which single options override.
void AddSkeletonOptions(CLI::App& command, SkeletonizeOptions& options,
                        std::optional<RootChoice>& root);

// Adds --root: where trees begin. It also requests their order.
void AddRoot(CLI::App& command, std::optional<RootChoice>& root);

// --swc-step.
void AddSwcStep(CLI::App& command, exporting::CurveSampling& sampling);

// Adds --min-voxels.
void AddMinVoxels(CLI::App& command, uint64_t& min_voxels);

// Checks that the options are consistent. Errors: INVALID_ARGUMENT.
absl::Status ValidateOptions(const SkeletonizeOptions& options);

// The same for the root of the skeletons of labels.
absl::Status ValidateRootOfLabels(const std::optional<RootChoice>& root);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_THINNING_OPTIONS_H_
