#include "proto/wire/options.h"

#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "proto/wire/enumerators.h"
#include "proto/wire/error_details.h"

namespace bccskel::wire {
namespace {

// Of several enumerators with one meaning, messages are given the first.

// Server and client hold them in memory with each job.
constexpr int kMostKeptPoints = 16384;

constexpr std::pair<v1::StubblePolicy, StubblePolicy> kStubblePolicies[] = {
    {v1::STUBBLE_POLICY_KEEP_TWO, StubblePolicy::kKeepTwo},
    {v1::STUBBLE_POLICY_UNSPECIFIED, StubblePolicy::kKeepTwo},
    {v1::STUBBLE_POLICY_LITERAL, StubblePolicy::kLiteral},
    {v1::STUBBLE_POLICY_NONE, StubblePolicy::kNone}};
constexpr std::pair<v1::ThinnessCleanup, ThinnessCleanup> kCleanups[] = {
    {v1::THINNESS_CLEANUP_ON, ThinnessCleanup::kOn},
    {v1::THINNESS_CLEANUP_UNSPECIFIED, ThinnessCleanup::kOn},
    {v1::THINNESS_CLEANUP_OFF, ThinnessCleanup::kOff}};
constexpr std::pair<v1::DistanceKind, DistanceKind> kDistanceKinds[] = {
    {v1::DISTANCE_KIND_CHAMFER, DistanceKind::kChamfer},
    {v1::DISTANCE_KIND_CHAMFER_OPTIMAL, DistanceKind::kChamferOptimal},
    {v1::DISTANCE_KIND_EUCLIDEAN, DistanceKind::kEuclidean},
    {v1::DISTANCE_KIND_UNSPECIFIED, DistanceKind::kEuclidean}};
// Unspecified is the default of SkeletonizeOptions.
constexpr std::pair<v1::ThinningMethod, ThinningMethod> kMethods[] = {
    {v1::THINNING_METHOD_DIRECTIONAL, ThinningMethod::kDirectional},
    {v1::THINNING_METHOD_DIRECTIONAL_ALTERNATING, ThinningMethod::kDirectionalAlternating},
    {v1::THINNING_METHOD_SYMMETRIC, ThinningMethod::kSymmetric}};
constexpr std::pair<v1::SkeletonKind, SkeletonKind> kSkeletonKinds[] = {
    {v1::SKELETON_KIND_CURVE, SkeletonKind::kCurve},
    {v1::SKELETON_KIND_UNSPECIFIED, SkeletonKind::kCurve},
    {v1::SKELETON_KIND_SURFACE, SkeletonKind::kSurface},
    {v1::SKELETON_KIND_KERNEL, SkeletonKind::kKernel},
    {v1::SKELETON_KIND_ISTHMUS_CURVE, SkeletonKind::kIsthmusCurve}};
constexpr std::pair<v1::PruningRule, PruningRule> kPruningRules[] = {
    {v1::PRUNING_RULE_SIGNIFICANCE, PruningRule::kSignificance},
    {v1::PRUNING_RULE_UNSPECIFIED, PruningRule::kSignificance},
    {v1::PRUNING_RULE_SLOPE, PruningRule::kSignificance},
    {v1::PRUNING_RULE_LENGTH, PruningRule::kLength},
    {v1::PRUNING_RULE_RELATIVE_LENGTH, PruningRule::kRelativeLength},
    {v1::PRUNING_RULE_PERSISTENCE, PruningRule::kPersistence},
    {v1::PRUNING_RULE_NONE, PruningRule::kNone}};
constexpr std::pair<v1::TipPlacement, TipPlacement> kTipPlacements[] = {
    {v1::TIP_PLACEMENT_RIDGE, TipPlacement::kRidge},
    {v1::TIP_PLACEMENT_UNSPECIFIED, TipPlacement::kRidge},
    {v1::TIP_PLACEMENT_AS_THINNED, TipPlacement::kAsThinned}};
// Points are left unspecified, so that such options keep their old bytes, and results their old
// key.
constexpr std::pair<v1::ObjectSource, ObjectSource> kObjectSources[] = {
    {v1::OBJECT_SOURCE_UNSPECIFIED, ObjectSource::kPoints},
    {v1::OBJECT_SOURCE_POINTS, ObjectSource::kPoints},
    {v1::OBJECT_SOURCE_VOXELS, ObjectSource::kVoxels},
    {v1::OBJECT_SOURCE_REFINED_VOXELS, ObjectSource::kRefinedVoxels},
    {v1::OBJECT_SOURCE_SAMPLED_VOXELS, ObjectSource::kSampledVoxels}};
constexpr std::pair<v1::CavityFilling, CavityFilling> kCavityFillings[] = {
    {v1::CAVITY_FILLING_OFF, CavityFilling::kOff},
    {v1::CAVITY_FILLING_UNSPECIFIED, CavityFilling::kOff},
    {v1::CAVITY_FILLING_ON, CavityFilling::kOn}};
constexpr std::pair<v1::KeptComponents, KeptComponents> kKeptComponents[] = {
    {v1::KEPT_COMPONENTS_ALL, KeptComponents::kAll},
    {v1::KEPT_COMPONENTS_UNSPECIFIED, KeptComponents::kAll},
    {v1::KEPT_COMPONENTS_LARGEST, KeptComponents::kLargest}};
constexpr std::pair<v1::Border, Border> kBorders[] = {
    {v1::BORDER_AUTO, Border::kAuto},
    {v1::BORDER_UNSPECIFIED, Border::kAuto},
    {v1::BORDER_ENDS, Border::kEnds},
    {v1::BORDER_CONTINUES, Border::kContinues},
    {v1::BORDER_CONTINUES_ACROSS_SLICE, Border::kContinuesAcrossSlice}};

// `what` names the kind of enumerators in the error for an unknown one.
template <typename Enumerator, typename Meaning, size_t kCount>
absl::StatusOr<Meaning> Known(Enumerator enumerator,
                              const std::pair<Enumerator, Meaning> (&known)[kCount],
                              const std::string& field, const char* what) {
  const std::optional<Meaning> meaning = MeaningOf(enumerator, known);
  if (meaning.has_value()) return *meaning;
  return InvalidField(field, absl::StrCat("unknown ", what, " ", int{enumerator}));
}

v1::PreparingOptions ToMessage(const PreparingOptions& preparing) {
  v1::PreparingOptions message;
  message.set_denoise_passes(preparing.denoise_passes);
  message.set_cavity_filling(EnumeratorOf(preparing.cavities, kCavityFillings));
  message.set_tunnel_width(preparing.tunnel_width);
  message.set_tunnel_cells(preparing.tunnel_cells);
  message.set_join_gaps(preparing.join_gaps);
  message.set_min_component_points(preparing.min_component_points);
  message.set_min_component_volume(preparing.min_component_volume);
  message.set_kept_components(EnumeratorOf(preparing.components, kKeptComponents));
  return message;
}

absl::StatusOr<PreparingOptions> FromMessage(const v1::PreparingOptions& message,
                                             const std::string& field) {
  PreparingOptions preparing;
  preparing.denoise_passes = message.denoise_passes();
  preparing.tunnel_width = message.tunnel_width();
  preparing.tunnel_cells = message.tunnel_cells();
  preparing.join_gaps = message.join_gaps();
  preparing.min_component_points = message.min_component_points();
  preparing.min_component_volume = message.min_component_volume();
  BCCSKEL_ASSIGN_OR_RETURN(preparing.cavities,
                           Known(message.cavity_filling(), kCavityFillings,
                                 field + ".cavity_filling", "filling of cavities"));
  BCCSKEL_ASSIGN_OR_RETURN(preparing.components,
                           Known(message.kept_components(), kKeptComponents,
                                 field + ".kept_components", "choice of components"));
  if (absl::Status checked = CheckPreparingOptions(preparing); !checked.ok()) {
    return InvalidField(field, std::string(checked.message()));
  }
  return preparing;
}

absl::Status ReadSlabs(const v1::SkeletonizeOptions& message, const std::string& field,
                       SkeletonizeOptions& options) {
  const auto& slabs = message.voxel_slabs();
  if (slabs.empty()) return absl::OkStatus();
  if (std::cmp_not_equal(slabs.size(), options.voxel_slabs.size())) {
    return InvalidField(field, absl::StrCat(slabs.size(), " numbers, must be 3 or none"));
  }
  std::ranges::transform(slabs, options.voxel_slabs.begin(), [](uint32_t count) {
    return static_cast<int32_t>(std::min(count, uint32_t{INT32_MAX}));  // too many either way
  });
  return absl::OkStatus();
}

absl::StatusOr<PruningOptions> PruningOf(const v1::SkeletonizeOptions& message,
                                         const std::string& field) {
  PruningOptions pruning;
  BCCSKEL_ASSIGN_OR_RETURN(pruning.rule, Known(message.pruning_rule(), kPruningRules,
                                               field + ".pruning_rule", "pruning rule"));
  BCCSKEL_ASSIGN_OR_RETURN(pruning.tips, Known(message.tip_placement(), kTipPlacements,
                                               field + ".tip_placement", "placement of tips"));
  pruning.threshold = message.pruning_threshold();
  if (message.pruning_rule() == v1::PRUNING_RULE_SLOPE && pruning.threshold != 0) {
    return InvalidField(field + ".pruning_threshold",
                        absl::StrCat("margin ", pruning.threshold,
                                     " of the slope rule, which no longer exists: use the rule "
                                     "SIGNIFICANCE and a threshold in half-widths (default 0.45)"));
  }
  if (absl::Status checked = CheckPruningOptions(pruning); !checked.ok()) {
    return InvalidField(field + ".pruning_threshold", std::string(checked.message()));
  }
  return pruning;
}

absl::StatusOr<std::vector<LatticePoint>> FromMessage(const v1::LatticePoints& message,
                                                      const std::string& field) {
  if (message.y_size() != message.x_size() || message.z_size() != message.x_size()) {
    return InvalidField(
        field, absl::StrCat("columns of ", message.x_size(), ", ", message.y_size(), " and ",
                            message.z_size(), " rows, must have equal lengths"));
  }
  if (message.x_size() > kMostKeptPoints) {
    return InvalidField(field,
                        absl::StrCat(message.x_size(), " points, the limit is ", kMostKeptPoints));
  }
  std::vector<LatticePoint> points;
  points.reserve(static_cast<size_t>(message.x_size()));
  for (int n = 0; n < message.x_size(); ++n) {
    points.push_back({message.x(n), message.y(n), message.z(n)});
  }
  return points;
}

}  // namespace

v1::SkeletonizeOptions ToMessage(const SkeletonizeOptions& options) {
  const ThinningOptions& thinning = options.thinning;
  v1::SkeletonizeOptions message;
  message.set_stubble_policy(EnumeratorOf(thinning.stubble, kStubblePolicies));
  message.set_thinness_cleanup(EnumeratorOf(thinning.cleanup, kCleanups));
  message.set_method(EnumeratorOf(thinning.method, kMethods));
  message.set_kind(EnumeratorOf(thinning.kind, kSkeletonKinds));
  message.set_shell_width(thinning.shell_width);
  message.set_last_shell(thinning.last_shell);
  message.set_distance_kind(EnumeratorOf(options.distance, kDistanceKinds));
  message.set_pruning_rule(EnumeratorOf(options.pruning.rule, kPruningRules));
  message.set_pruning_threshold(options.pruning.threshold);
  message.set_tip_placement(EnumeratorOf(options.pruning.tips, kTipPlacements));
  message.set_junction_reach(options.junction_reach);
  message.set_border(EnumeratorOf(options.border, kBorders));
  *message.mutable_preparing() = ToMessage(options.preparing);
  message.set_object_source(EnumeratorOf(options.source, kObjectSources));
  if (options.voxel_slabs != decltype(options.voxel_slabs){1, 1, 1}) {
    message.mutable_voxel_slabs()->Assign(options.voxel_slabs.begin(), options.voxel_slabs.end());
  }
  for (LatticePoint p : thinning.keep) {
    message.mutable_keep()->add_x(p.x);
    message.mutable_keep()->add_y(p.y);
    message.mutable_keep()->add_z(p.z);
  }
  return message;
}

absl::StatusOr<SkeletonizeOptions> FromMessage(const v1::SkeletonizeOptions& message,
                                               const std::string& field) {
  SkeletonizeOptions options;
  ThinningOptions& thinning = options.thinning;
  BCCSKEL_ASSIGN_OR_RETURN(thinning.stubble, Known(message.stubble_policy(), kStubblePolicies,
                                                   field + ".stubble_policy", "policy"));
  BCCSKEL_ASSIGN_OR_RETURN(thinning.cleanup, Known(message.thinness_cleanup(), kCleanups,
                                                   field + ".thinness_cleanup", "clean-up"));
  if (message.method() != v1::THINNING_METHOD_UNSPECIFIED) {
    BCCSKEL_ASSIGN_OR_RETURN(thinning.method,
                             Known(message.method(), kMethods, field + ".method", "method"));
  }
  BCCSKEL_ASSIGN_OR_RETURN(
      thinning.kind, Known(message.kind(), kSkeletonKinds, field + ".kind", "kind of skeleton"));
  BCCSKEL_ASSIGN_OR_RETURN(thinning.keep, FromMessage(message.keep(), field + ".keep"));
  BCCSKEL_ASSIGN_OR_RETURN(options.distance, Known(message.distance_kind(), kDistanceKinds,
                                                   field + ".distance_kind", "kind of distance"));
  BCCSKEL_ASSIGN_OR_RETURN(options.pruning, PruningOf(message, field));
  BCCSKEL_ASSIGN_OR_RETURN(options.preparing,
                           FromMessage(message.preparing(), field + ".preparing"));
  BCCSKEL_ASSIGN_OR_RETURN(options.source, Known(message.object_source(), kObjectSources,
                                                 field + ".object_source", "source"));
  BCCSKEL_RETURN_IF_ERROR(ReadSlabs(message, field + ".voxel_slabs", options));
  BCCSKEL_ASSIGN_OR_RETURN(options.border,
                           Known(message.border(), kBorders, field + ".border", "border"));
  if (message.has_junction_reach()) options.junction_reach = message.junction_reach();
  if (message.shell_width() != 0) thinning.shell_width = message.shell_width();
  thinning.last_shell = message.last_shell();
  if (absl::Status checked = CheckSkeletonizeOptions(options); !checked.ok()) {
    return InvalidField(field, std::string(checked.message()));
  }
  return options;
}

}  // namespace bccskel::wire
