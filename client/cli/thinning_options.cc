#include "client/cli/thinning_options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <span>
#include <string>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/option_values.h"
#include "core/pipeline/option_words.h"
#include "core/pipeline/presets.h"

namespace bccskel::cli {
namespace {

// CLI11 applies options in the order in which they were added: single options come after the preset
// and override it.
void AddPreset(CLI::App& command, SkeletonizeOptions& options) {
  std::vector<std::string> names;
  std::string text =
      "Options for a kind of data; explicit options override them (flags as "
      "--fill-cavities=false):";
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
      ->option_text(absl::StrJoin(names, "|"));
}

// That of a preset is a significance.
void DropPresetsThreshold(const CLI::App& command, PruningOptions& pruning) {
  if (command.count("--pruning-threshold") == 0) pruning.threshold = 0;
}

void AddPreparing(CLI::App& command, PreparingOptions& preparing) {
  command
      .add_option("--denoise", preparing.denoise_passes,
                  "Set each point to the majority of its neighborhood, N times, up to 16; removes "
                  "limbs one or two lattice units thick (default 0)")
      ->check(Within(0, kMaxDenoisePasses))
      ->option_text("N");
  // With "=false", flags override those of a preset.
  command.add_flag_function(
      "--fill-cavities",
      [&preparing](int64_t given) {
        preparing.cavities = given > 0 ? CavityFilling::kOn : CavityFilling::kOff;
      },
      "Fill the cavities of the object; each leaves a closed surface in the skeleton");
  command
      .add_option(
          "--join-gaps", preparing.join_gaps,
          "Join components at most X world units apart, the nearest first (default 0: none)")
      ->check(Within(0, kMaxGapToJoin))
      ->option_text("X");
  AddCount<uint64_t>(
      command, "--min-component",
      [&preparing](uint64_t points) {
        preparing.min_component_points = points;
        preparing.component_size = ComponentSize::kPoints;
      },
      "Drop components of fewer than N points (default 0)");
  command
      .add_option("--min-component-volume", preparing.min_component_volume,
                  "Drop components smaller than X cubic world units (default 0)")
      ->check(Within(0, std::numeric_limits<double>::max()))
      ->option_text("X");
  command.add_flag_function(
      "--keep-largest",
      [&preparing](int64_t given) {
        preparing.components = given > 0 ? KeptComponents::kLargest : KeptComponents::kAll;
      },
      "Drop all components but the largest");
  command
      .add_option_function<double>(
          "--cut-loops",
          [&preparing](double width) {
            preparing.tunnel_width = width;
            preparing.tunnel_cells = 0;
          },
          "Fill tunnels narrower than X world units; each makes a loop in the skeleton "
          "(default 0: none)")
      ->check(Within(0, kMaxTunnelWidthToFill))
      ->option_text("X");
}

void AddDistance(CLI::App& command, DistanceKind& distance) {
  AddChoice<DistanceKind>(command, "--distance", distance,
                          "Distance that defines the shells (default euclidean)",
                          Choices(kDistanceWords));
}

// 0 would mean the default.
CLI::Validator Threshold() {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0;
    if (!absl::SimpleAtod(text, &value)) return "";  // told as no number
    if (value > 0 && value <= kMaxPruningThreshold) return "";
    return absl::StrCat("must be above 0, up to 1e9, not ", text,
                        value == 0 ? "; --pruning none keeps every branch" : "");
  };
  return {check, ""};
}

void AddPruning(CLI::App& command, PruningOptions& pruning) {
  AddChoice<PruningRule>(
      command, "--pruning",
      [&](PruningRule rule) {
        pruning.rule = rule;
        if (rule != PruningRule::kSignificance) DropPresetsThreshold(command, pruning);
      },
      "Which branches with a free end to remove (default significance)", Choices(kPruningWords));
  command
      .add_option(
          "--pruning-threshold", pruning.threshold,
          "Significance: how far a branch sticks out, in half-widths of the object beside it "
          "(default 0.45); length: world units; relative-length: radii of the junction "
          "(default 1); persistence: thinning passes (default 6)")
      ->check(Threshold())
      ->option_text("X");
  AddChoice<TipPlacement>(
      command, "--tips", pruning.tips,
      "Where branches end: at the end of the distance ridge (default), or as thinned",
      Choices(kTipsWords));
}

void AddJunctions(CLI::App& command, double& reach) {
  command
      .add_option(
          "--merge-junctions", reach,
          "Merge junctions within X radii of the deepest of them, or of thinner limbs, into "
          "one node, up to 4; 0 merges none (default 1.25)")
      ->check(Within(0, kMaxJunctionReach))
      ->option_text("X");
}

void AddBorder(CLI::App& command, Border& border) {
  AddChoice<Border>(
      command, "--border", border,
      "What lies beyond the border of an image or a volume: background, with the curves of limbs "
      "that an image cuts off led to the middle of the cut (ends), unknown (continues), or unknown "
      "beyond the faces of an image that cut limbs off and background beyond the others (auto, "
      "default); across an image of one slice the object always continues",
      Choices(std::span(kBorderWords).first<3>()));
}

// Refuses options of what a skeleton does not have, also with their defaults: whoever states one
// takes it for having an effect. CLI11 has counted all options before it applies the first, and
// those of pruning were applied before those of thinning.
void RefuseOfCurves(const CLI::App& command, const PruningOptions& pruning,
                    const std::string& why) {
  const bool rule = command.count("--pruning") > 0 && pruning.rule != PruningRule::kNone;
  if (!rule && command.count("--pruning-threshold") + command.count("--tips") == 0) return;
  throw CLI::ValidationError("--pruning, --pruning-threshold and --tips are for curves, and " +
                             why);
}

void RefuseOfGraphs(const CLI::App& command, double junction_reach) {
  if (command.count("--merge-junctions") == 0 || junction_reach == 0) return;
  throw CLI::ValidationError(
      "--merge-junctions is for graphs of curves, not for --kind surface and --last-shell");
}

void TakeKind(const CLI::App& command, SkeletonKind kind, SkeletonizeOptions& options) {
  options.thinning.kind = kind;
  if (kind != SkeletonKind::kCurve) DropPresetsThreshold(command, options.pruning);
  if (kind == SkeletonKind::kKernel) {
    RefuseOfCurves(command, options.pruning, "--kind kernel has none");
  }
  if (kind != SkeletonKind::kSurface) return;
  if (command.count("--tips") > 0) {
    throw CLI::ValidationError("--tips is for curves, and --kind surface has none");
  }
  RefuseOfGraphs(command, options.junction_reach);
}

void TakeLastShell(const CLI::App& command, int32_t shell, SkeletonizeOptions& options) {
  options.thinning.last_shell = shell;
  if (shell <= 0) return;
  DropPresetsThreshold(command, options.pruning);
  RefuseOfCurves(command, options.pruning, "--last-shell stops before there are curves");
  RefuseOfGraphs(command, options.junction_reach);
}

void AddThinning(CLI::App& command, SkeletonizeOptions& options) {
  ThinningOptions& thinning = options.thinning;
  AddChoice<ThinningMethod>(command, "--method", thinning.method,
                            "How points are chosen for removal (default symmetric)",
                            Choices(kMethodWords));
  AddChoice<SkeletonKind>(
      command, "--kind",
      [&command, &options](SkeletonKind kind) { TakeKind(command, kind, options); },
      "What to keep; all kinds except curve (default) need --method symmetric",
      Choices(kKindWords));
  AddChoice<StubblePolicy>(
      command, "--stubble", thinning.stubble,
      "Which stubble, the one-point twigs of thinning, to remove (default keep-two)",
      Choices(kStubbleWords));
  command
      .add_option("--shell-width", thinning.shell_width,
                  "Thickness of a shell in lattice units, 0.75 to 64 (default 1)")
      ->check(Within(kMinShellWidth, kMaxShellWidth))
      ->option_text("X");
  command
      .add_option_function<int32_t>(
          "--last-shell",
          [&command, &options](int32_t shell) { TakeLastShell(command, shell, options); },
          "Stop after this shell; 0 thins to the end (default)")
      ->check(Within(0, std::numeric_limits<double>::max()))
      ->option_text("N");
  command.add_flag_callback(
      "--no-cleanup", [&thinning] { thinning.cleanup = ThinnessCleanup::kOff; },
      "Keep the simple points that parallel thinning leaves");
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
  AddThinning(command, options);
  AddRoot(command, root);
}

namespace {

RootChoice ReadRoot(const std::string& text) {
  RootChoice choice;
  if (text == "thickest-end") return choice;
  if (text == "thickest-node") {
    choice.rule = RootChoice::Rule::kDeepestNode;
    return choice;
  }
  const auto all_read = [&](int end) { return text.size() == static_cast<size_t>(end); };
  int end = 0;
  if (text.starts_with("node:")) {
    choice.rule = RootChoice::Rule::kNodes;
    choice.nodes = {ReadCount<uint32_t>("--root node", text.substr(5))};
    return choice;
  }
  WorldPoint& p = choice.point;
  choice.rule = RootChoice::Rule::kNearestNode;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &p[0], &p[1], &p[2], &end) == 3 && all_read(end) &&
      std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) {
    return choice;
  }
  throw CLI::ValidationError(
      "--root " + text +
      ": must be thickest-end, thickest-node, a point like 1.5,20,3 or a node "
      "like node:7");
}

}  // namespace

void AddRoot(CLI::App& command, std::optional<RootChoice>& root) {
  command
      .add_option_function<std::string>(
          "--root", [&root](const std::string& text) { root = ReadRoot(text); },
          "Order the skeleton as trees from a root: generation, Strahler order, distance and path "
          "to "
          "the root. The root is the thickest end, the thickest node (such as a soma), the node "
          "nearest to a point in world coordinates, or a node by its number. Edges that close "
          "loops are left out")
      ->option_text("thickest-end|thickest-node|X,Y,Z|node:N");
}

void AddSwcStep(CLI::App& command, exporting::CurveSampling& sampling) {
  command
      .add_option(
          "--swc-step", sampling.step,
          "Distance between SWC points along the smooth curve, in world units; 0: the lattice "
          "points, not smoothed (default: twice the smallest spacing, or an eighth of the largest "
          "if that is more)")
      ->check(Within(0, std::numeric_limits<double>::max()))
      ->option_text("LENGTH");
}

void AddMinVoxels(CLI::App& command, uint64_t& min_voxels) {
  AddCount(command, "--min-voxels", min_voxels, "Skip labels of fewer than N voxels (default 1)");
}

absl::Status ValidateOptions(const SkeletonizeOptions& options) {
  if (options.pruning.rule == PruningRule::kLength && options.pruning.threshold == 0) {
    return absl::InvalidArgumentError(
        "--pruning length needs --pruning-threshold, the length in world units");
  }
  if (options.pruning.rule == PruningRule::kNone && options.pruning.threshold != 0) {
    return absl::InvalidArgumentError(
        "--pruning-threshold is for a rule of pruning, not for --pruning none");
  }
  return CheckSkeletonizeOptions(options);
}

absl::Status ValidateRootOfLabels(const std::optional<RootChoice>& root) {
  if (!root.has_value() || root->rule != RootChoice::Rule::kNodes) return absl::OkStatus();
  return absl::InvalidArgumentError("--root node:N names a node of one skeleton; labels have many");
}

}  // namespace bccskel::cli
