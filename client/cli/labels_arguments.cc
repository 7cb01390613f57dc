#include "client/cli/labels_arguments.h"

#include <CLI/CLI.hpp>

#include "client/cli/count_option.h"
#include "client/cli/swc_argument.h"
#include "client/cli/thinning_arguments.h"

namespace bccskel::cli {

void AddMinVoxels(CLI::App& command, uint64_t& min_voxels) {
  AddCount(command, "--min-voxels", min_voxels, "Leave out labels with fewer voxels (default 1)");
}

void AddLabels(CLI::App& command, LabelsArguments& arguments) {
  command.add_option("IMAGE", arguments.input, "Image file of labels")
      ->required()
      ->option_text(" ");
  command
      .add_option("-o,--output", arguments.outputs,
                  "Output file: with {label} in its path one file per label, in any format but "
                  "pictures; else all labels in a .vtp, .graphml, .json, .csv, .glb, .mrk.json or "
                  ".precomputed; "
                  "may be given several times")
      ->required()
      ->allow_extra_args(false)
      ->option_text("FILE (required)");
  AddSwcStep(command, arguments.swc);
  AddLabelImage(command, arguments.image);
  AddMinVoxels(command, arguments.min_voxels);
  AddSkeletonOptions(command, arguments.skeletonize, arguments.root);
  command.add_flag_callback(
      "--local", [] {}, "Allowed, and does nothing: labels are always computed here");
}

}  // namespace bccskel::cli
