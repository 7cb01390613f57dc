#include "proto/wire/options.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "proto/wire/error_details.h"

namespace bccskel::wire {
namespace {

v1::StubblePolicy ToMessage(StubblePolicy policy) {
  switch (policy) {
    case StubblePolicy::kKeepTwo:
      return v1::STUBBLE_POLICY_KEEP_TWO;
    case StubblePolicy::kLiteral:
      return v1::STUBBLE_POLICY_LITERAL;
    case StubblePolicy::kNone:
      return v1::STUBBLE_POLICY_NONE;
  }
  return v1::STUBBLE_POLICY_UNSPECIFIED;
}

absl::StatusOr<StubblePolicy> FromMessage(v1::StubblePolicy policy, const std::string& field) {
  switch (policy) {
    case v1::STUBBLE_POLICY_UNSPECIFIED:
    case v1::STUBBLE_POLICY_KEEP_TWO:
      return StubblePolicy::kKeepTwo;
    case v1::STUBBLE_POLICY_LITERAL:
      return StubblePolicy::kLiteral;
    case v1::STUBBLE_POLICY_NONE:
      return StubblePolicy::kNone;
    default:
      return InvalidField(field, absl::StrCat("unknown policy ", int{policy}));
  }
}

absl::StatusOr<ThinnessCleanup> FromMessage(v1::ThinnessCleanup cleanup, const std::string& field) {
  switch (cleanup) {
    case v1::THINNESS_CLEANUP_UNSPECIFIED:
    case v1::THINNESS_CLEANUP_ON:
      return ThinnessCleanup::kOn;
    case v1::THINNESS_CLEANUP_OFF:
      return ThinnessCleanup::kOff;
    default:
      return InvalidField(field, absl::StrCat("unknown clean-up ", int{cleanup}));
  }
}

v1::DistanceKind ToMessage(DistanceKind kind) {
  switch (kind) {
    case DistanceKind::kChamfer:
      return v1::DISTANCE_KIND_CHAMFER;
    case DistanceKind::kChamferOptimal:
      return v1::DISTANCE_KIND_CHAMFER_OPTIMAL;
    case DistanceKind::kEuclidean:
      return v1::DISTANCE_KIND_EUCLIDEAN;
  }
  return v1::DISTANCE_KIND_UNSPECIFIED;
}

absl::StatusOr<DistanceKind> FromMessage(v1::DistanceKind kind, const std::string& field) {
  switch (kind) {
    case v1::DISTANCE_KIND_CHAMFER:
      return DistanceKind::kChamfer;
    case v1::DISTANCE_KIND_CHAMFER_OPTIMAL:
      return DistanceKind::kChamferOptimal;
    case v1::DISTANCE_KIND_UNSPECIFIED:
    case v1::DISTANCE_KIND_EUCLIDEAN:
      return DistanceKind::kEuclidean;
    default:
      return InvalidField(field, absl::StrCat("unknown kind of distance ", int{kind}));
  }
}

v1::ThinningMethod ToMessage(ThinningMethod method) {
  switch (method) {
    case ThinningMethod::kDirectional:
      return v1::THINNING_METHOD_DIRECTIONAL;
    case ThinningMethod::kDirectionalAlternating:
      return v1::THINNING_METHOD_DIRECTIONAL_ALTERNATING;
    case ThinningMethod::kSymmetric:
      return v1::THINNING_METHOD_SYMMETRIC;
  }
  return v1::THINNING_METHOD_UNSPECIFIED;
}

absl::StatusOr<ThinningMethod> FromMessage(v1::ThinningMethod method, const std::string& field) {
  switch (method) {
    case v1::THINNING_METHOD_UNSPECIFIED:
      return SkeletonizeOptions().thinning.method;
    case v1::THINNING_METHOD_DIRECTIONAL:
      return ThinningMethod::kDirectional;
    case v1::THINNING_METHOD_DIRECTIONAL_ALTERNATING:
      return ThinningMethod::kDirectionalAlternating;
    case v1::THINNING_METHOD_SYMMETRIC:
      return ThinningMethod::kSymmetric;
    default:
      return InvalidField(field, absl::StrCat("unknown method ", int{method}));
  }
}

v1::SkeletonKind ToMessage(SkeletonKind kind) {
  switch (kind) {
    case SkeletonKind::kCurve:
      return v1::SKELETON_KIND_CURVE;
    case SkeletonKind::kSurface:
      return v1::SKELETON_KIND_SURFACE;
    case SkeletonKind::kKernel:
      return v1::SKELETON_KIND_KERNEL;
    case SkeletonKind::kIsthmusCurve:
      return v1::SKELETON_KIND_ISTHMUS_CURVE;
  }
  return v1::SKELETON_KIND_UNSPECIFIED;
}

absl::StatusOr<SkeletonKind> FromMessage(v1::SkeletonKind kind, const std::string& field) {
  switch (kind) {
    case v1::SKELETON_KIND_UNSPECIFIED:
    case v1::SKELETON_KIND_CURVE:
      return SkeletonKind::kCurve;
    case v1::SKELETON_KIND_SURFACE:
      return SkeletonKind::kSurface;
    case v1::SKELETON_KIND_KERNEL:
      return SkeletonKind::kKernel;
    case v1::SKELETON_KIND_ISTHMUS_CURVE:
      return SkeletonKind::kIsthmusCurve;
    default:
      return InvalidField(field, absl::StrCat("unknown kind of skeleton ", int{kind}));
  }
}

v1::PruningRule ToMessage(PruningRule rule) {
  switch (rule) {
    case PruningRule::kSignificance:
      return v1::PRUNING_RULE_SIGNIFICANCE;
    case PruningRule::kLength:
      return v1::PRUNING_RULE_LENGTH;
    case PruningRule::kRelativeLength:
      return v1::PRUNING_RULE_RELATIVE_LENGTH;
    case PruningRule::kPersistence:
      return v1::PRUNING_RULE_PERSISTENCE;
    case PruningRule::kNone:
      return v1::PRUNING_RULE_NONE;
  }
  return v1::PRUNING_RULE_UNSPECIFIED;
}

absl::StatusOr<PruningRule> FromMessage(v1::PruningRule rule, const std::string& field) {
  switch (rule) {
    case v1::PRUNING_RULE_UNSPECIFIED:
    case v1::PRUNING_RULE_SLOPE:
    case v1::PRUNING_RULE_SIGNIFICANCE:
      return PruningRule::kSignificance;
    case v1::PRUNING_RULE_LENGTH:
      return PruningRule::kLength;
    case v1::PRUNING_RULE_RELATIVE_LENGTH:
      return PruningRule::kRelativeLength;
    case v1::PRUNING_RULE_PERSISTENCE:
      return PruningRule::kPersistence;
    case v1::PRUNING_RULE_NONE:
      return PruningRule::kNone;
    default:
      return InvalidField(field, absl::StrCat("unknown pruning rule ", int{rule}));
  }
}

v1::ObjectSource ToMessage(ObjectSource source) {
  switch (source) {
    case ObjectSource::kPoints:
      break;  // omitted, so that such options keep their old bytes, and results their old key
    case ObjectSource::kVoxels:
      return v1::OBJECT_SOURCE_VOXELS;
    case ObjectSource::kRefinedVoxels:
      return v1::OBJECT_SOURCE_REFINED_VOXELS;
    case ObjectSource::kSampledVoxels:
      return v1::OBJECT_SOURCE_SAMPLED_VOXELS;
  }
  return v1::OBJECT_SOURCE_UNSPECIFIED;
}

absl::StatusOr<ObjectSource> FromMessage(v1::ObjectSource source, const std::string& field) {
  switch (source) {
    case v1::OBJECT_SOURCE_UNSPECIFIED:
    case v1::OBJECT_SOURCE_POINTS:
      return ObjectSource::kPoints;
    case v1::OBJECT_SOURCE_VOXELS:
      return ObjectSource::kVoxels;
    case v1::OBJECT_SOURCE_REFINED_VOXELS:
      return ObjectSource::kRefinedVoxels;
    case v1::OBJECT_SOURCE_SAMPLED_VOXELS:
      return ObjectSource::kSampledVoxels;
    default:
      return InvalidField(field, absl::StrCat("unknown source ", int{source}));
  }
}

absl::StatusOr<TipPlacement> FromMessage(v1::TipPlacement tips, const std::string& field) {
  switch (tips) {
    case v1::TIP_PLACEMENT_UNSPECIFIED:
    case v1::TIP_PLACEMENT_RIDGE:
      return TipPlacement::kRidge;
    case v1::TIP_PLACEMENT_AS_THINNED:
      return TipPlacement::kAsThinned;
    default:
      return InvalidField(field, absl::StrCat("unknown placement of tips ", int{tips}));
  }
}

absl::StatusOr<CavityFilling> FromMessage(v1::CavityFilling filling, const std::string& field) {
  switch (filling) {
    case v1::CAVITY_FILLING_UNSPECIFIED:
    case v1::CAVITY_FILLING_OFF:
      return CavityFilling::kOff;
    case v1::CAVITY_FILLING_ON:
      return CavityFilling::kOn;
    default:
      return InvalidField(field, absl::StrCat("unknown filling of cavities ", int{filling}));
  }
}

absl::StatusOr<KeptComponents> FromMessage(v1::KeptComponents kept, const std::string& field) {
  switch (kept) {
    case v1::KEPT_COMPONENTS_UNSPECIFIED:
    case v1::KEPT_COMPONENTS_ALL:
      return KeptComponents::kAll;
    case v1::KEPT_COMPONENTS_LARGEST:
      return KeptComponents::kLargest;
    default:
      return InvalidField(field, absl::StrCat("unknown choice of components ", int{kept}));
  }
}

v1::Border ToMessage(Border border) {
  if (border == Border::kContinues) return v1::BORDER_CONTINUES;
  return border == Border::kEnds ? v1::BORDER_ENDS : v1::BORDER_CONTINUES_ACROSS_SLICE;
}

absl::StatusOr<Border> FromMessage(v1::Border border, const std::string& field) {
  switch (border) {
    case v1::BORDER_UNSPECIFIED:
    case v1::BORDER_ENDS:
      return Border::kEnds;
    case v1::BORDER_CONTINUES:
      return Border::kContinues;
    case v1::BORDER_CONTINUES_ACROSS_SLICE:
      return Border::kContinuesAcrossSlice;
    default:
      return InvalidField(field, absl::StrCat("unknown border ", int{border}));
  }
}

v1::PreparingOptions ToMessage(const PreparingOptions& preparing) {
  v1::PreparingOptions message;
  message.set_denoise_passes(preparing.denoise_passes);
  message.set_cavity_filling(preparing.cavities == CavityFilling::kOn ? v1::CAVITY_FILLING_ON
                                                                      : v1::CAVITY_FILLING_OFF);
  message.set_tunnel_width(preparing.tunnel_width);
  message.set_tunnel_cells(preparing.tunnel_cells);
  message.set_min_component_points(preparing.min_component_points);
  message.set_min_component_volume(preparing.min_component_volume);
  message.set_kept_components(preparing.components == KeptComponents::kLargest
                                  ? v1::KEPT_COMPONENTS_LARGEST
                                  : v1::KEPT_COMPONENTS_ALL);
  return message;
}

absl::StatusOr<PreparingOptions> FromMessage(const v1::PreparingOptions& message,
                                             const std::string& field) {
  PreparingOptions preparing;
  preparing.denoise_passes = message.denoise_passes();
  preparing.tunnel_width = message.tunnel_width();
  preparing.tunnel_cells = message.tunnel_cells();
  preparing.min_component_points = message.min_component_points();
  preparing.min_component_volume = message.min_component_volume();
  BCCSKEL_ASSIGN_OR_RETURN(preparing.cavities,
                           FromMessage(message.cavity_filling(), field + ".cavity_filling"));
  BCCSKEL_ASSIGN_OR_RETURN(preparing.components,
                           FromMessage(message.kept_components(), field + ".kept_components"));
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
  BCCSKEL_ASSIGN_OR_RETURN(pruning.rule,
                           FromMessage(message.pruning_rule(), field + ".pruning_rule"));
  BCCSKEL_ASSIGN_OR_RETURN(pruning.tips,
                           FromMessage(message.tip_placement(), field + ".tip_placement"));
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
  message.set_stubble_policy(ToMessage(thinning.stubble));
  message.set_thinness_cleanup(thinning.cleanup == ThinnessCleanup::kOn ? v1::THINNESS_CLEANUP_ON
                                                                        : v1::THINNESS_CLEANUP_OFF);
  message.set_method(ToMessage(thinning.method));
  message.set_kind(ToMessage(thinning.kind));
  message.set_shell_width(thinning.shell_width);
  message.set_last_shell(thinning.last_shell);
  message.set_distance_kind(ToMessage(options.distance));
  message.set_pruning_rule(ToMessage(options.pruning.rule));
  message.set_pruning_threshold(options.pruning.threshold);
  message.set_tip_placement(options.pruning.tips == TipPlacement::kRidge
                                ? v1::TIP_PLACEMENT_RIDGE
                                : v1::TIP_PLACEMENT_AS_THINNED);
  message.set_junction_reach(options.junction_reach);
  message.set_border(ToMessage(options.border));
  *message.mutable_preparing() = ToMessage(options.preparing);
  message.set_object_source(ToMessage(options.source));
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
  BCCSKEL_ASSIGN_OR_RETURN(thinning.stubble,
                           FromMessage(message.stubble_policy(), field + ".stubble_policy"));
  BCCSKEL_ASSIGN_OR_RETURN(thinning.cleanup,
                           FromMessage(message.thinness_cleanup(), field + ".thinness_cleanup"));
  BCCSKEL_ASSIGN_OR_RETURN(thinning.method, FromMessage(message.method(), field + ".method"));
  BCCSKEL_ASSIGN_OR_RETURN(thinning.kind, FromMessage(message.kind(), field + ".kind"));
  BCCSKEL_ASSIGN_OR_RETURN(thinning.keep, FromMessage(message.keep(), field + ".keep"));
  BCCSKEL_ASSIGN_OR_RETURN(options.distance,
                           FromMessage(message.distance_kind(), field + ".distance_kind"));
  BCCSKEL_ASSIGN_OR_RETURN(options.pruning, PruningOf(message, field));
  BCCSKEL_ASSIGN_OR_RETURN(options.preparing,
                           FromMessage(message.preparing(), field + ".preparing"));
  BCCSKEL_ASSIGN_OR_RETURN(options.source,
                           FromMessage(message.object_source(), field + ".object_source"));
  BCCSKEL_RETURN_IF_ERROR(ReadSlabs(message, field + ".voxel_slabs", options));
  BCCSKEL_ASSIGN_OR_RETURN(options.border, FromMessage(message.border(), field + ".border"));
  if (message.has_junction_reach()) options.junction_reach = message.junction_reach();
  if (message.shell_width() != 0) thinning.shell_width = message.shell_width();
  thinning.last_shell = message.last_shell();
  if (absl::Status checked = CheckSkeletonizeOptions(options); !checked.ok()) {
    return InvalidField(field, std::string(checked.message()));
  }
  return options;
}

}  // namespace bccskel::wire
