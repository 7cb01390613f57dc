#include "client/cli/thinning_arguments.h"

#include "client/cli/choice_option.h"
#include "client/cli/method_words.h"

namespace bccskel::cli {

void AddDistance(CLI::App& command, DistanceKind& distance) {
  AddChoice<DistanceKind>(command, "--distance", distance,
                          "How the distances that make the shells are measured (default chamfer)",
                          {{"chamfer", DistanceKind::kChamfer},
                           {"chamfer-optimal", DistanceKind::kChamferOptimal},
                           {"euclidean", DistanceKind::kEuclidean}});
}

void AddPruning(CLI::App& command, PruningOptions& pruning) {
  AddChoice<PruningRule>(command, "--pruning", pruning.rule,
                         "Which branches with a free end to remove (default slope)",
                         {{"slope", PruningRule::kSlope},
                          {"length", PruningRule::kLength},
                          {"relative-length", PruningRule::kRelativeLength},
                          {"none", PruningRule::kNone}});
  command
      .add_option("--pruning-threshold", pruning.threshold,
                  "Margin in lattice units for slope (default 4), world units for length, radii of "
                  "the junction for relative-length (default 1)")
      ->option_text("X");
  AddChoice<TipPlacement>(
      command, "--tips", pruning.tips,
      "Where branches end: where the ridge of the distances does (default), or "
      "as thinned",
      {{"ridge", TipPlacement::kRidge}, {"as-thinned", TipPlacement::kAsThinned}});
}

void AddThinning(CLI::App& command, ThinningOptions& thinning) {
  AddChoice<ThinningMethod>(command, "--method", thinning.method,
                            "How points are chosen for removal (default symmetric)", MethodWords());
  AddChoice<SkeletonKind>(command, "--kind", thinning.kind,
                          "What to keep; all but curve (default) need the symmetric method",
                          {{"curve", SkeletonKind::kCurve},
                           {"surface", SkeletonKind::kSurface},
                           {"kernel", SkeletonKind::kKernel},
                           {"isthmus-curve", SkeletonKind::kIsthmusCurve}});
  AddChoice<StubblePolicy>(command, "--stubble", thinning.stubble,
                           "Which stubble points to remove (default keep-two)",
                           {{"keep-two", StubblePolicy::kKeepTwo},
                            {"literal", StubblePolicy::kLiteral},
                            {"none", StubblePolicy::kNone}});
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

}  // namespace bccskel::cli
