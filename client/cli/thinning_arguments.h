#ifndef BCCSKEL_CLIENT_CLI_THINNING_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_THINNING_ARGUMENTS_H_

#include "core/distance/distance_field.h"
#include "core/prepare/prepare.h"
#include "core/pruning/prune.h"
#include "core/thinning/thinning.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Adds the options that say what is done to an object before, how it is thinned and what is pruned.
void AddPreparing(CLI::App& command, PreparingOptions& preparing);
void AddDistance(CLI::App& command, DistanceKind& distance);
void AddPruning(CLI::App& command, PruningOptions& pruning);
void AddJunctions(CLI::App& command, double& reach);
void AddThinning(CLI::App& command, ThinningOptions& thinning);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_THINNING_ARGUMENTS_H_
