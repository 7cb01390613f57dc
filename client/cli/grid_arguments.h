#ifndef BCCSKEL_CLIENT_CLI_GRID_ARGUMENTS_H_
#define BCCSKEL_CLIENT_CLI_GRID_ARGUMENTS_H_

#include "core/import/voxelize/voxelize.h"

namespace CLI {
class App;
}

namespace bccskel::cli {

// Adds the options that say how a mesh is filled with lattice points.
void AddGrid(CLI::App& command, VoxelizeOptions& grid);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_GRID_ARGUMENTS_H_
