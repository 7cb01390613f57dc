#ifndef BCCSKEL_CLIENT_CLI_THINNING_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_THINNING_ARGUMENTS_H_

#include "core/distance/distance_field.h"
#include "core/thinning/thinning.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Adds the options that say how an object is thinned.
void AddDistance(CLI::App& command, DistanceKind& distance);
void AddThinning(CLI::App& command, ThinningOptions& thinning);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_THINNING_ARGUMENTS_H_
