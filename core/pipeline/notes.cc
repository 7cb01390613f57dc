#include "core/pipeline/notes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "absl/strings/str_format.h"
#include "core/certificate/describe_changes.h"
#include "core/distance/chamfer_weights.h"
#include "core/distance/places.h"
#include "core/pipeline/skeletonize_within.h"
#include "core/skeleton/narrow_loops.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel {
namespace {

using Notes = std::vector<std::string>;

bool MakesCurves(SkeletonKind kind) {
  return kind == SkeletonKind::kCurve || kind == SkeletonKind::kIsthmusCurve;
}

std::string Counted(int64_t count, const char* one, const char* many) {
  return absl::StrFormat("%d %s", count, count == 1 ? one : many);
}

// To three digits.
double RoundedUp(double length) {
  const double digit = std::pow(10, std::floor(std::log10(length)) - 2);
  return std::ceil(length / digit - 1e-6) * digit;
}

void AddCavities(const SkeletonizeResult& result, Notes& notes) {
  const int64_t cavities = result.certificate.input.cavities;
  if (cavities == 0 || !MakesCurves(result.options.thinning.kind)) return;
  notes.push_back(
      Counted(cavities, "cavity leaves a closed surface", "cavities leave closed surfaces") +
      " among the curves, and lengths of branches that meet there include paths over " +
      (cavities == 1 ? "it; " : "them; ") + "--fill-cavities fills cavities before thinning");
}

// Noise that opens so many tunnels also makes bumps. They remain where tunnels are closed, and have
// branches of their own. Where each voxel has more than two points, denoising leaves them.
constexpr int64_t kLoopsOfRoughSurface = 10;

// Tunnels that noise opens split limbs into rings, which have no ends.
void AddNarrowLoops(const SkeletonizeResult& result, Notes& notes) {
  const SkeletonizeOptions& options = result.options;
  const double edge = SurfaceStepOf(options.source);  // of the shortest, in lattice units
  if (edge == 1 || !MakesCurves(options.thinning.kind)) return;
  const Placement& placement = result.graph.placement;
  const double unit = WorldUnitsPerLatticeUnit(placement);
  const double width = unit * TunnelWidthOf(edge, placement);  // two voxels
  const PreparingOptions& preparing = options.preparing;
  const double cut =
      std::max(preparing.tunnel_width, unit * CellsPerVoxel(options.source) *
                                           TunnelWidthOf(preparing.tunnel_cells, placement));
  const bool dust = result.certificate.input.components > 1 &&
                    preparing.min_component_points == 0 && preparing.min_component_volume == 0;
  if (cut > 0 && (cut < width || !dust)) return;
  const auto loops = static_cast<int64_t>(CountNarrowLoops(result.graph, width));
  if (loops == 0) return;
  const AxisScale scale = AxisScaleOf(placement);
  const bool cubes = std::ranges::max(scale) == std::ranges::min(scale);
  const std::string what = "at least " + Counted(loops, "loop is", "loops are") +
                           absl::StrFormat(" narrower than %g %s", width / (edge * unit),
                                           cubes ? "voxels" : "times the shortest edge of a voxel");
  if (cut > 0) {
    notes.push_back(what +
                    "; tunnels with another component in them stay open: --min-component "
                    "200 drops specks before");
    return;
  }
  const bool rough = loops >= kLoopsOfRoughSurface && preparing.denoise_passes == 0 &&
                     options.source == ObjectSource::kVoxels;
  notes.push_back(what +
                  absl::StrFormat(", as noise produces them; --cut-loops %g closes such "
                                  "tunnels before thinning",
                                  RoundedUp(width)) +
                  (rough ? "; if the surface is rough, --denoise 2 --min-component 200 smooths it "
                           "but removes limbs one or two lattice units thick"
                         : ""));
}

// The lattice points of a voxel, and of a row of voxels for each more. Those on its faces count,
// of which a volume knows nothing. 0 for objects without exact voxels.
class VoxelPointCounts {
 public:
  explicit VoxelPointCounts(const SkeletonizeOptions& options) {
    if (!IsConverted(options.source)) return;
    for (size_t axis = 0; axis < 3; ++axis) {
      parts_[axis] = CellsPerVoxel(options.source) * std::max(options.voxel_slabs[axis], 1);
    }
    const auto [x, y, z] = parts_;
    of_voxel_ = x * y * z + (x + 1) * (y + 1) * (z + 1);
    for (size_t axis = 0; axis < 3; ++axis) {
      of_next_[axis] = x * y * z + (x + 1) * (y + 1) * (z + 1) / (parts_[axis] + 1) * parts_[axis];
    }
  }

  double OfVoxel() const { return of_voxel_; }
  double OfStep(LatticePoint a, LatticePoint b) const {
    const std::array<double, 3> step = {std::abs(b.x - a.x) / (2 * parts_[0]),
                                        std::abs(b.y - a.y) / (2 * parts_[1]),
                                        std::abs(b.z - a.z) / (2 * parts_[2])};
    const auto axis = static_cast<size_t>(std::ranges::max_element(step) - step.begin());
    return step[axis] * of_next_[axis];
  }

 private:
  std::array<double, 3> parts_ = {1, 1, 1};
  double of_voxel_ = 0;
  std::array<double, 3> of_next_ = {};
};

// The share of the object in the balls along the curves: those of isolated points, and for each
// edge its tube and its largest ball. Too large where these overlap. A curve holds at least the
// voxels that it runs through, which may be wider than its balls and all that there is.
double ShareInBalls(const SkeletonizeResult& result) {
  constexpr double kVolumeOfPoint = 4;  // in lattice units
  const SkeletonGraph& graph = result.graph;
  const AxisScale scale = AxisScaleOf(graph.placement);
  const double cell = kVolumeOfPoint * scale[0] * scale[1] * scale[2];
  const VoxelPointCounts voxels(result.options);
  const auto ball = [&](double r) {
    return std::max(4 * std::numbers::pi / 3 * r * r * r / cell, voxels.OfVoxel());
  };
  double held = 0;
  for (const SkeletonNode& node : graph.nodes) {
    if (node.kind == NodeKind::kIsolated) held += ball(node.at.radius);
  }
  for (const SkeletonEdge& edge : graph.edges) {
    const std::span<const SkeletonPoint> points = graph.PointsOf(edge);
    double largest = points[0].radius;
    for (size_t n = 1; n < points.size(); ++n) {
      const LatticePoint from = points[n - 1].point, to = points[n].point;
      const double radius = points[n].radius;
      const double tube = std::numbers::pi * radius * radius * StraightDistance(from, to, scale);
      held += std::max(tube / cell, voxels.OfStep(from, to));
      largest = std::max(largest, radius);
    }
    held += ball(largest);
  }
  return held / static_cast<double>(result.object_points);
}

// Curves represent plates and shells poorly.
void AddFlatObject(const SkeletonizeResult& result, Notes& notes) {
  constexpr double kLeastShare = 0.2;  // the share for limbs four times as wide as thick
  const ThinningOptions& thinning = result.options.thinning;
  if (result.object_points == 0 || result.certificate.input.cavities > 0 ||
      !MakesCurves(thinning.kind) || thinning.last_shell > 0) {
    return;
  }
  const double share = ShareInBalls(result);
  if (share >= kLeastShare) return;
  notes.push_back(
      absl::StrFormat("the balls along the curves hold about %.0f %% of the object, as in plates "
                      "and shells; --kind surface describes these by sheets",
                      100 * share));
}

// Notes a number of components that is seldom intended.
void AddSpecks(const SkeletonizeResult& result, Notes& notes) {
  constexpr int64_t kMany = 1000;
  const int64_t components = result.certificate.input.components;
  const PreparingOptions& preparing = result.options.preparing;
  if (components < kMany || preparing.min_component_points > 0 ||
      preparing.min_component_volume > 0) {
    return;
  }
  notes.push_back(absl::StrFormat(
      "the object has %d components, as noise produces specks; --min-component 200 drops small "
      "ones, --keep-largest all but one",
      components));
}

void AddEmpty(const SkeletonizeResult& result, Notes& notes) {
  if (result.certificate.Given() == BettiNumbers()) notes.push_back("the object has no points");
}

// A conversion that is not a sampling keeps the topology.
void AddSampling(const SkeletonizeResult& result, Notes& notes) {
  const Certificate& certificate = result.certificate;
  if (!certificate.sampled || certificate.MaskKept()) return;
  notes.push_back(
      "sampling changed the topology: " + DescribeChanges(*certificate.mask, certificate.Given()) +
      "; the exact conversion (default) keeps it");
}

void AddPreparing(const SkeletonizeResult& result, Notes& notes) {
  const BettiNumbers &before = result.certificate.Given(), &after = result.certificate.input;
  if (result.object_points == 0 && !result.preparing.empty() && before != BettiNumbers()) {
    const auto emptied =
        std::ranges::find_if(result.preparing.rbegin(), result.preparing.rend(),
                             [](const PreparingStep& step) { return step.points_removed > 0; });
    notes.push_back("nothing is left of the object after preparing" +
                    (emptied == result.preparing.rend() ? "" : ": " + WordsFor(*emptied)));
    return;
  }
  if (before == after) return;
  notes.push_back("preparing changed the topology: " + DescribeChanges(before, after));
}

void AddSimplePoints(const SkeletonizeResult& result, Notes& notes) {
  const ThinningOptions& thinning = result.options.thinning;
  const uint64_t left = result.certificate.simple_points_left;
  if (left == 0) return;
  const char* why = thinning.last_shell > 0 ? "thinning was told to stop at a shell"
                    : thinning.cleanup == ThinnessCleanup::kOff ? "the clean-up was turned off"
                                                                : "they were not removed";
  notes.push_back(
      absl::StrFormat("%d simple %s left: %s", left, left == 1 ? "point is" : "points are", why));
}

}  // namespace

std::vector<std::string> NotesOn(const SkeletonizeResult& result) {
  Notes notes;
  AddEmpty(result, notes);
  AddSampling(result, notes);
  AddPreparing(result, notes);
  AddCavities(result, notes);
  AddFlatObject(result, notes);
  AddNarrowLoops(result, notes);
  AddSpecks(result, notes);
  AddSimplePoints(result, notes);
  return notes;
}

std::string WordsFor(const PreparingStep& step) {
  const auto count = static_cast<int64_t>(step.count);
  switch (step.kind) {
    case PreparingStepKind::kDenoise:
      return "denoised in " + Counted(count, "pass", "passes");
    case PreparingStepKind::kFillCavities:
      return Counted(count, "cavity", "cavities") + " filled";
    case PreparingStepKind::kFillTunnels:
      return Counted(count, "tunnel", "tunnels") + " filled";
    case PreparingStepKind::kJoinGaps:
      return Counted(count, "gap", "gaps") + " joined";
    case PreparingStepKind::kDropSmallComponents:
      return Counted(count, "small component", "small components") + " dropped";
    case PreparingStepKind::kKeepLargestComponent:
      return Counted(count, "component", "components") + " dropped beside the largest";
  }
  return "";
}

}  // namespace bccskel
