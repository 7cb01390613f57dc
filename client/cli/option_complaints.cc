#include "client/cli/option_complaints.h"

#include "core/pipeline/canonical_options.h"
#include "core/pipeline/option_words.h"

namespace bccskel::cli {
namespace {

using Complaint = std::optional<std::string>;

// Options of pruning that would do nothing.
Complaint PruningComplaint(const SkeletonizeOptions& options) {
  const PruningOptions& pruning = options.pruning;
  if (pruning.rule == PruningRule::kNone && pruning.threshold != 0) {
    return "--pruning-threshold is for a rule of pruning, not for --pruning none";
  }
  const bool asked = pruning.rule != PruningRule::kNone && pruning != PruningOptions();
  if (!asked || HasCurves(options.thinning)) return std::nullopt;
  if (HasSheets(options.thinning)) {
    if (pruning.tips == TipPlacement::kRidge) return std::nullopt;
    return "--tips is for curves, and --kind surface has none";
  }
  const std::string why =
      options.thinning.last_shell > 0
          ? "--last-shell stops before there are curves"
          : std::string("--kind ") + WordFor(kKindWords, options.thinning.kind) + " has none";
  return "--pruning, --pruning-threshold and --tips are for curves, and " + why;
}

Complaint JunctionComplaint(const SkeletonizeOptions& options) {
  const bool asked = options.junction_reach != 0 && options.junction_reach != kDefaultJunctionReach;
  if (!asked || HasGraphOfCurves(options.thinning)) return std::nullopt;
  return "--merge-junctions is for graphs of curves, not for --kind surface and --last-shell";
}

}  // namespace

std::optional<std::string> ComplaintAboutOptions(const SkeletonizeOptions& options) {
  const absl::Status sound = CheckSkeletonizeOptions(options);
  if (!sound.ok()) return std::string(sound.message());
  if (Complaint c = JunctionComplaint(options); c.has_value()) return c;
  return PruningComplaint(options);
}

std::optional<std::string> ComplaintAboutRootOfLabels(const std::optional<RootChoice>& root) {
  if (!root.has_value() || root->rule != RootChoice::Rule::kNode) return std::nullopt;
  return "--root node:N names a node of one skeleton; labels have many";
}

}  // namespace bccskel::cli
