#ifndef BCCSKEL_CLIENT_CLI_LABELS_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_LABELS_ARGUMENTS_H_

#include "client/cli/arguments.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Adds --min-voxels.
void AddMinVoxels(CLI::App& command, uint64_t& min_voxels);

// Adds the options of `labels` without those that all commands know.
void AddLabels(CLI::App& command, LabelsArguments& arguments);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_LABELS_ARGUMENTS_H_
