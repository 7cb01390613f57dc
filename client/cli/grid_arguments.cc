#include "client/cli/grid_arguments.h"

#include "client/cli/choice_option.h"
#include "client/cli/count_option.h"

namespace bccskel::cli {

void AddGrid(CLI::App& command, VoxelizeOptions& grid) {
  CLI::Option* points = AddCount<uint64_t>(
      command, "--points", [&grid](uint64_t count) { grid.points = count; },
      "Lattice points the solid shall have");
  command.add_option("--spacing", grid.spacing, "Edge of the cubic cell, in the mesh's unit")
      ->excludes(points)
      ->option_text("LENGTH");
  AddChoice<FillRule>(
      command, "--fill", grid.fill, "What is inside a mesh (default auto)",
      {{"auto", FillRule::kAuto}, {"parity", FillRule::kParity}, {"winding", FillRule::kWinding}});
}

}  // namespace bccskel::cli
