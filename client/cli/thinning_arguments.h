#ifndef BCCSKEL_CLIENT_CLI_THINNING_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_THINNING_ARGUMENTS_H_

#include "core/pipeline/skeletonize.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Adds the options that say what is done to an object before, how it is thinned and what is pruned;
// and the presets of them, which single options overrule.
void AddSkeletonizeOptions(CLI::App& command, SkeletonizeOptions& options);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_THINNING_ARGUMENTS_H_
