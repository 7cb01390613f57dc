#include "client/cli/swc_argument.h"

#include <CLI/CLI.hpp>
#include <limits>

namespace bccskel::cli {

void AddSwcStep(CLI::App& command, exporting::CurveSampling& sampling) {
  command
      .add_option("--swc-step", sampling.step,
                  "Distance of SWC's points along the smooth curve, in the world's unit; 0: the "
                  "lattice points, not smoothed (default twice the smallest spacing)")
      ->check(CLI::Range(0.0, std::numeric_limits<double>::max()))
      ->option_text("LENGTH");
}

}  // namespace bccskel::cli
