#include "core/prepare/prepare.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "core/distance/chamfer_weights.h"
#include "core/exec/status_macros.h"
#include "core/prepare/denoise.h"
#include "core/prepare/fill_cavities.h"
#include "core/prepare/fill_tunnels.h"
#include "core/prepare/join_gaps.h"
#include "core/prepare/keep_components.h"

namespace bccskel {
namespace {

// The least number of points that fill the volume. A cubic cell holds two points.
uint64_t PointsIn(double volume, const Placement& placement) {
  const double point = placement.spacing[0] * placement.spacing[1] * placement.spacing[2] / 2;
  constexpr double kAllPoints = 0x1p63;
  return static_cast<uint64_t>(std::min(std::ceil(volume / point), kAllPoints));
}

class Preparation {
 public:
  Preparation(const Volume& object, const PreparingOptions& options, exec::MemoryBudget& memory,
              const exec::Context& context, int32_t cells_per_voxel)
      : options_(options), memory_(memory), context_(context), cells_per_voxel_(cells_per_voxel) {
    prepared_.object = object;
  }

  absl::StatusOr<PreparedObject> Run() && {
    BCCSKEL_ASSIGN_OR_RETURN(prepared_.before, CountBettiNumbers(prepared_.object, context_));
    if (options_.denoise_passes > 0) BCCSKEL_RETURN_IF_ERROR(RunDenoise());
    if (options_.cavities == CavityFilling::kOn) {
      BCCSKEL_RETURN_IF_ERROR(Take(PreparingStepKind::kFillCavities,
                                   FillCavities(prepared_.object, options_.max_bricks, context_)));
    }
    if (options_.join_gaps > 0) BCCSKEL_RETURN_IF_ERROR(RunJoinGaps());
    const uint64_t least =
        std::max(options_.min_component_points,
                 PointsIn(options_.min_component_volume, prepared_.object.placement()));
    if (least > 0) {
      BCCSKEL_RETURN_IF_ERROR(Take(PreparingStepKind::kDropSmallComponents,
                                   DropSmallComponents(prepared_.object, least, context_)));
    }
    if (options_.components == KeptComponents::kLargest) {
      BCCSKEL_RETURN_IF_ERROR(Take(PreparingStepKind::kKeepLargestComponent,
                                   KeepLargestComponent(prepared_.object, context_)));
    }
    // After the components: a tunnel with dust in it stays open.
    if (options_.tunnel_width > 0 || options_.tunnel_cells > 0) {
      BCCSKEL_RETURN_IF_ERROR(RunFillTunnels());
    }
    return std::move(prepared_);
  }

 private:
  absl::Status RunDenoise() {
    PreparingStep step = {.kind = PreparingStepKind::kDenoise};
    for (int32_t pass = 0; pass < options_.denoise_passes; ++pass) {
      BCCSKEL_ASSIGN_OR_RETURN(ChangedVolume changed, Denoise(prepared_.object, context_));
      if (changed.points_added + changed.points_removed == 0) break;
      ++step.count;
      step.points_added += changed.points_added;
      step.points_removed += changed.points_removed;
      prepared_.object = std::move(changed.object);
    }
    prepared_.steps.push_back(step);
    return absl::OkStatus();
  }

  absl::Status RunJoinGaps() {
    const double unit = WorldUnitsPerLatticeUnit(prepared_.object.placement());
    const double gap = options_.join_gaps / unit;
    if (gap > kMaxGap) {
      return absl::InvalidArgumentError(
          absl::StrFormat("gaps to join %g: must be at most %g, that is %g edges of the cubic cell",
                          options_.join_gaps, kMaxGap * unit, kMaxGap / 2));
    }
    return Take(PreparingStepKind::kJoinGaps, JoinGaps(prepared_.object, gap, memory_, context_));
  }

  absl::Status RunFillTunnels() {
    const double unit = WorldUnitsPerLatticeUnit(prepared_.object.placement());
    const double width = std::max(
        options_.tunnel_width / unit,
        cells_per_voxel_ * TunnelWidthOf(options_.tunnel_cells, prepared_.object.placement()));
    if (width > kMaxTunnelWidth) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "width of tunnels to fill %g: must be at most %g, that is %g edges of the cubic cell",
          width * unit, kMaxTunnelWidth * unit, kMaxTunnelWidth / 2));
    }
    return Take(PreparingStepKind::kFillTunnels,
                FillTunnels(prepared_.object, width, memory_, context_));
  }

  absl::Status Take(PreparingStepKind kind, absl::StatusOr<ChangedVolume> changed) {
    if (!changed.ok()) return changed.status();
    prepared_.object = std::move(changed->object);
    prepared_.steps.push_back(
        {kind, changed->count, changed->points_added, changed->points_removed});
    return absl::OkStatus();
  }

  const PreparingOptions& options_;
  exec::MemoryBudget& memory_;
  const exec::Context& context_;
  const int32_t cells_per_voxel_;
  PreparedObject prepared_;
};

}  // namespace

double TunnelWidthOf(double cells, const Placement& placement) {
  constexpr double kWiderThanGap = 1.25;
  const double longest = std::ranges::max(AxisScaleOf(placement));
  return 2 * std::max(cells, std::min(cells, kWiderThanGap) * longest);
}

absl::Status CheckPreparingOptions(const PreparingOptions& options) {
  if (options.denoise_passes < 0 || options.denoise_passes > kMaxDenoisePasses) {
    return absl::InvalidArgumentError(absl::StrFormat("%d denoising passes: must be 0 to %d",
                                                      options.denoise_passes, kMaxDenoisePasses));
  }
  for (const double width : {options.tunnel_width, options.tunnel_cells}) {
    if (width >= 0 && width <= kMaxTunnelWidthToFill) continue;
    return absl::InvalidArgumentError(absl::StrFormat(
        "width of tunnels to fill %g: must be 0 to %g", width, kMaxTunnelWidthToFill));
  }
  if (!(options.join_gaps >= 0 && options.join_gaps <= kMaxGapToJoin)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("gaps to join %g: must be 0 to %g", options.join_gaps, kMaxGapToJoin));
  }
  if (!(options.min_component_volume >= 0 && std::isfinite(options.min_component_volume))) {
    return absl::InvalidArgumentError(
        absl::StrFormat("least volume of a component %g: must be 0 or more, and finite",
                        options.min_component_volume));
  }
  return absl::OkStatus();
}

absl::StatusOr<PreparedObject> Prepare(const Volume& object, const PreparingOptions& options,
                                       exec::MemoryBudget& memory, const exec::Context& context,
                                       int32_t cells_per_voxel) {
  BCCSKEL_RETURN_IF_ERROR(CheckPreparingOptions(options));
  return Preparation(object, options, memory, context, cells_per_voxel).Run();
}

}  // namespace bccskel
