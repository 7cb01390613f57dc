#ifndef BCCSKEL_CLIENT_CLI_THINNING_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_THINNING_ARGUMENTS_H_

#include <optional>

#include "core/pipeline/skeletonize.h"
#include "core/skeleton/tree_order.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Adds the options that say what is done to an object before, how it is thinned, what is pruned and
// where its trees begin; and the presets of them, which single options overrule.
void AddSkeletonOptions(CLI::App& command, SkeletonizeOptions& options,
                        std::optional<RootChoice>& root);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_THINNING_ARGUMENTS_H_
