#include "core/pipeline/notes.h"

#include <algorithm>
#include <ranges>

#include "absl/strings/str_format.h"
#include "core/certificate/describe_changes.h"
#include "core/distance/chamfer_weights.h"
#include "core/exec/disjoint_sets.h"

namespace bccskel {
namespace {

using Notes = std::vector<std::string>;

bool MakesCurves(SkeletonKind kind) {
  return kind == SkeletonKind::kCurve || kind == SkeletonKind::kIsthmusCurve;
}

std::string Counted(int64_t count, const char* one, const char* many) {
  return absl::StrFormat("%d %s", count, count == 1 ? one : many);
}

void AddCavities(const SkeletonizeResult& result, Notes& notes) {
  const int64_t cavities = result.certificate.input.cavities;
  if (cavities == 0 || !MakesCurves(result.options.thinning.kind)) return;
  notes.push_back(
      Counted(cavities, "cavity leaves a closed surface", "cavities leave closed surfaces") +
      " among the curves; --fill-cavities fills cavities before thinning");
}

// How many loops close only through edges as thin as a voxel somewhere and four times as thick
// elsewhere: what is thin all along is a thin object. `voxel` is its edge in lattice units.
int64_t CountThinLoops(const SkeletonGraph& graph, double voxel) {
  DisjointSets joined(graph.nodes.size());
  int64_t count = 0;
  for (const bool thin : {false, true}) {
    for (const SkeletonEdge& edge : graph.edges) {
      const auto radii = graph.PointsOf(edge) | std::views::transform(&SkeletonPoint::radius);
      const bool is_thin = !radii.empty() && std::ranges::min(radii) <= 0.75 * voxel &&
                           std::ranges::max(radii) >= 2 * voxel;
      if (is_thin != thin) continue;
      if (thin && joined.Find(edge.source) == joined.Find(edge.target)) ++count;
      joined.Join(edge.source, edge.target);
    }
  }
  return count;
}

// Of images only: what is thin in a mesh is no noise.
void AddThinLoops(const SkeletonizeResult& result, Notes& notes) {
  const SkeletonizeOptions& options = result.options;
  const bool cuts = options.preparing.tunnel_width > 0 || options.preparing.tunnel_cells > 0;
  const int64_t loops = result.certificate.input.loops;
  if (options.source == ObjectSource::kPoints || cuts || loops == 0) return;
  if (!MakesCurves(options.thinning.kind)) return;
  const double edge = SurfaceStepOf(options.source);  // of a voxel
  const int64_t count = CountThinLoops(result.graph, edge);
  if (count == 0) return;
  notes.push_back(
      absl::StrFormat("%d of %s through parts as thin as a voxel; where noise made them, "
                      "--cut-loops %g fills their tunnels",
                      count, Counted(loops, "loop closes", "loops close"),
                      2 * edge * WorldUnitsPerLatticeUnit(result.graph.placement)));
}

void AddEmpty(const SkeletonizeResult& result, Notes& notes) {
  if (result.certificate.Given() == BettiNumbers()) notes.push_back("the object has no points");
}

void AddPreparing(const SkeletonizeResult& result, Notes& notes) {
  const BettiNumbers &before = result.certificate.Given(), &after = result.certificate.input;
  if (result.object_points == 0 && !result.preparing.empty() && before != BettiNumbers()) {
    notes.push_back("nothing is left of the object after preparing");
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
  AddPreparing(result, notes);
  AddCavities(result, notes);
  AddThinLoops(result, notes);
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
    case PreparingStepKind::kDropSmallComponents:
      return Counted(count, "small component", "small components") + " dropped";
    case PreparingStepKind::kKeepLargestComponent:
      return Counted(count, "component", "components") + " dropped beside the largest";
  }
  return "";
}

}  // namespace bccskel
