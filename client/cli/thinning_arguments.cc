#include "client/cli/thinning_arguments.h"

#include "client/cli/choice_option.h"
#include "client/cli/count_option.h"
#include "client/cli/root_argument.h"
#include "core/pipeline/option_words.h"
#include "core/pipeline/presets.h"

namespace bccskel::cli {
namespace {

// CLI11 takes the options in the order in which they were added: what is given by itself comes
// later and stays.
void AddPreset(CLI::App& command, SkeletonizeOptions& options) {
  std::vector<std::string> names;
  std::string text = "Options for a kind of data, which those given by themselves overrule:";
  for (const Preset& preset : Presets()) {
    names.push_back(preset.name);
    text += std::string("\n") + preset.name + " = " + OptionsOf(preset) + ": " + preset.data;
  }
  command
      .add_option_function<std::string>(
          "--preset",
          [&options](const std::string& name) {
            const absl::Status known = ApplyPreset(name, options);
            if (!known.ok()) throw CLI::ValidationError("--" + std::string(known.message()));
          },
          text)
      ->option_text(CLI::detail::join(names, "|"));
}

void AddPreparing(CLI::App& command, PreparingOptions& preparing) {
  command
      .add_option("--denoise", preparing.denoise_passes,
                  "First set every point to the majority around it, so many times, up to 16; "
                  "destroys what is one or two lattice units thick (default 0)")
      ->option_text("N");
  command.add_flag_callback(
      "--fill-cavities", [&preparing] { preparing.cavities = CavityFilling::kOn; },
      "Fill the cavities of the object, which leave closed surfaces in a skeleton");
  command
      .add_option("--cut-loops", preparing.tunnel_width,
                  "Fill tunnels that are narrower, in world units, each of which makes a loop "
                  "(default 0: none)")
      ->option_text("X");
  AddCount(command, "--min-component", preparing.min_component_points,
           "Drop components of fewer points (default 0)");
  command
      .add_option("--min-component-volume", preparing.min_component_volume,
                  "Drop components of a smaller volume, in cubic world units (default 0)")
      ->option_text("X");
  command.add_flag_callback(
      "--keep-largest", [&preparing] { preparing.components = KeptComponents::kLargest; },
      "Drop all components but the largest");
}

void AddDistance(CLI::App& command, DistanceKind& distance) {
  AddChoice<DistanceKind>(command, "--distance", distance,
                          "How the distances that make the shells are measured (default euclidean)",
                          Choices(kDistanceWords));
}

void AddPruning(CLI::App& command, PruningOptions& pruning) {
  AddChoice<PruningRule>(command, "--pruning", pruning.rule,
                         "Which branches with a free end to remove (default significance)",
                         Choices(kPruningWords));
  command
      .add_option("--pruning-threshold", pruning.threshold,
                  "How far a branch must stick out: half-widths of the object beside it for "
                  "significance (default 0.47), world units for length, radii of the junction for "
                  "relative-length (default 1), passes "
                  "of thinning for persistence (default 6)")
      ->option_text("X");
  AddChoice<TipPlacement>(
      command, "--tips", pruning.tips,
      "Where branches end: where the ridge of the distances does (default), or as thinned",
      Choices(kTipsWords));
}

void AddJunctions(CLI::App& command, double& reach) {
  command
      .add_option("--merge-junctions", reach,
                  "Make one node of junctions that lie within so many radii of the deepest of "
                  "them or of thinner limbs, up to 4; 0 leaves all (default 1.25)")
      ->option_text("X");
}

void AddBorder(CLI::App& command, Border& border) {
  AddChoice<Border>(command, "--border", border,
                    "What lies beyond the border of an image or a volume: nothing (default), or "
                    "more of what is cut off there, which then runs straight to the border",
                    Choices(kBorderWords));
}

void AddThinning(CLI::App& command, ThinningOptions& thinning) {
  AddChoice<ThinningMethod>(command, "--method", thinning.method,
                            "How points are chosen for removal (default symmetric)",
                            Choices(kMethodWords));
  AddChoice<SkeletonKind>(command, "--kind", thinning.kind,
                          "What to keep; all but curve (default) need the symmetric method",
                          Choices(kKindWords));
  AddChoice<StubblePolicy>(command, "--stubble", thinning.stubble,
                           "Which stubble points to remove (default keep-two)",
                           Choices(kStubbleWords));
  command
      .add_option("--shell-width", thinning.shell_width,
                  "Thickness of a shell in lattice units, 0.75 to 64 (default 1)")
      ->option_text("X");
  command
      .add_option("--last-shell", thinning.last_shell,
                  "Stop after this shell; 0 thins to the end (default)")
      ->option_text("N");
  command.add_flag_callback(
      "--no-cleanup", [&thinning] { thinning.cleanup = ThinnessCleanup::kOff; },
      "Leave the simple points that parallel thinning leaves");
}

}  // namespace

void AddSkeletonOptions(CLI::App& command, SkeletonizeOptions& options,
                        std::optional<RootChoice>& root) {
  AddPreset(command, options);
  AddPreparing(command, options.preparing);
  AddDistance(command, options.distance);
  AddPruning(command, options.pruning);
  AddJunctions(command, options.junction_reach);
  AddBorder(command, options.border);
  AddThinning(command, options.thinning);
  AddRoot(command, root);
}

}  // namespace bccskel::cli
