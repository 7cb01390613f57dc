#include "core/voxelize/voxelize.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/voxelize/boundary_caps.h"
#include "core/voxelize/generalized_winding.h"
#include "core/voxelize/grid_fit.h"
#include "core/voxelize/row_fill.h"

namespace bccskel {
namespace {

class ParityRule : public SegmentRule {
 public:
  void Append(const LatticeRow&, CellSpan segment, int, int crossings,
              std::vector<CellSpan>& inside) const override {
    if (crossings % 2 != 0) inside.push_back(segment);
  }
};

class WindingRule : public SegmentRule {
 public:
  void Append(const LatticeRow&, CellSpan segment, int winding, int,
              std::vector<CellSpan>& inside) const override {
    if (winding != 0) inside.push_back(segment);
  }
};

absl::Status CheckOptions(const VoxelizeOptions& options) {
  if (options.points.has_value() == options.spacing.has_value()) {
    return absl::InvalidArgumentError(
        "exactly one of the number of points and the spacing must be given");
  }
  if (options.points && (*options.points < 1 || *options.points > options.max_points)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%d points wanted: must be 1 to %d", *options.points, options.max_points));
  }
  if (options.spacing && !(*options.spacing > 0 && std::isfinite(*options.spacing))) {
    return absl::InvalidArgumentError(
        absl::StrFormat("spacing %g: must be finite and positive", *options.spacing));
  }
  return absl::OkStatus();
}

absl::Status CheckTriangles(const Surface& surface) {
  if (!surface.triangles.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      "nothing enclosed: every triangle of the mesh names a vertex twice after joining equal "
      "vertices (are coordinates in float too far from the origin?)");
}

absl::Status CheckSize(const Surface& surface) {
  if (std::ranges::min(surface.upper_unit) <= 0) {
    return absl::InvalidArgumentError("nothing enclosed: the mesh is flat along an axis");
  }
  if (!std::isfinite(2 * surface.half_size) || 2 * surface.half_size < 1e-290) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the mesh is 2 * %g wide: must be 1e-290 to 1.7e308", surface.half_size));
  }
  return absl::OkStatus();
}

std::string DescribeDefects(const MeshReport& mesh) {
  return absl::StrFormat("%d boundary edges, %d non-manifold edges, %d misoriented edges",
                         mesh.boundary_edges, mesh.non_manifold_edges, mesh.misoriented_edges);
}

// The rule that kAuto stands for, or an error when the rule does not fit the mesh.
absl::StatusOr<FillRule> ChooseRule(const MeshReport& mesh, FillRule wanted) {
  const bool open = mesh.closure == SurfaceClosure::kOpen;
  if (open && wanted == FillRule::kAuto) {
    return absl::FailedPreconditionError(absl::StrFormat(
        "the mesh is not closed (%s); repair it or fill it by winding number (--fill winding)",
        DescribeDefects(mesh)));
  }
  if (open && wanted == FillRule::kParity) {
    return absl::InvalidArgumentError(
        absl::StrFormat("parity needs a closed mesh, this one has %s", DescribeDefects(mesh)));
  }
  if (wanted == FillRule::kWinding && mesh.closure == SurfaceClosure::kClosed) {
    return absl::InvalidArgumentError(
        absl::StrFormat("winding needs a consistently oriented mesh, this one has %s: use parity",
                        DescribeDefects(mesh)));
  }
  if (wanted != FillRule::kAuto) return wanted;
  return mesh.closure == SurfaceClosure::kOriented ? FillRule::kWinding : FillRule::kParity;
}

// +1 or -1 per triangle, so that every root component turns outward.
std::vector<int8_t> TriangleSigns(const Surface& surface) {
  std::vector<int8_t> signs(surface.triangles.size());
  const std::vector<SurfaceComponent>& components = surface.report.components;
  for (size_t t = 0; t < signs.size(); ++t) {
    const SurfaceComponent& root = components[components[surface.component_of[t]].root];
    signs[t] = root.volume < 0 ? -1 : 1;
  }
  return signs;
}

// An open surface made closed, and the sense in which it turns outward.
struct CappedSurface {
  BoundaryCaps caps;
  std::vector<TriangleMesh::Vertex> vertices;  // of the surface, then the apexes
  std::vector<TriangleMesh::Triangle> triangles;
  int8_t sign = 1;
};

double SignedVolume(const CappedSurface& capped) {
  double volume = 0;
  for (const auto& [u, v, w] : capped.triangles) {
    const auto &a = capped.vertices[u], &b = capped.vertices[v], &c = capped.vertices[w];
    volume += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
              a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return volume / 6;
}

CappedSurface CapSurface(const Surface& surface) {
  CappedSurface capped = {CapBoundary(surface), surface.vertices, surface.triangles};
  const BoundaryCaps& caps = capped.caps;
  capped.vertices.insert(capped.vertices.end(), caps.apexes.begin(), caps.apexes.end());
  capped.triangles.insert(capped.triangles.end(), caps.triangles.begin(), caps.triangles.end());
  capped.sign = SignedVolume(capped) < 0 ? -1 : 1;
  return capped;
}

class Voxelizer {
 public:
  Voxelizer(Surface surface, const VoxelizeOptions& options, const exec::Context& context)
      : surface_(std::move(surface)), options_(options), context_(context) {}

  absl::StatusOr<VoxelizeResult> Run() {
    BCCSKEL_RETURN_IF_ERROR(CheckTriangles(surface_));
    BCCSKEL_ASSIGN_OR_RETURN(rule_, ChooseRule(surface_.report, options_.fill));
    BCCSKEL_RETURN_IF_ERROR(CheckSize(surface_));
    WarnAboutSurface();
    VoxelizeResult result;
    if (options_.spacing) {
      const double unit_spacing = *options_.spacing / surface_.half_size / 2;
      BCCSKEL_ASSIGN_OR_RETURN(result.volume, Fill(unit_spacing));
    } else {
      BCCSKEL_ASSIGN_OR_RETURN(result.volume, FillToCount(*options_.points));
    }
    result.fill = rule_;
    result.warnings = std::move(warnings_);
    result.mesh = std::move(surface_.report);
    return result;
  }

 private:
  void WarnAboutSurface() {
    const MeshReport& mesh = surface_.report;
    if (mesh.closure == SurfaceClosure::kOpen) {
      warnings_.push_back(absl::StrFormat(
          "the mesh is not closed (%s): filled where its generalized winding number exceeds 1/2",
          DescribeDefects(mesh)));
    } else if (mesh.closure == SurfaceClosure::kClosed) {
      warnings_.push_back(
          absl::StrFormat("the mesh is not consistently oriented (%d edges): filled by parity",
                          mesh.misoriented_edges));
    }
    if (mesh.dropped_triangles > 0) {
      warnings_.push_back(
          absl::StrFormat("%d degenerate triangles were dropped", mesh.dropped_triangles));
    }
  }

  absl::StatusOr<Volume> Fill(double unit_spacing) {
    BCCSKEL_ASSIGN_OR_RETURN(const GridFit fit, FitGrid(surface_, unit_spacing));
    if (surface_.report.closure == SurfaceClosure::kOpen) return FillOpen(fit);
    const FillRequest request = {
        fit.extent,         fit.placement,           SnapAll(fit, surface_.vertices),
        surface_.triangles, TriangleSigns(surface_), options_.max_points};
    if (rule_ == FillRule::kParity) return FillRows(request, ParityRule(), context_);
    return FillRows(request, WindingRule(), context_);
  }

  absl::StatusOr<Volume> FillOpen(const GridFit& fit) {
    if (!capped_) capped_ = CapSurface(surface_);
    const FillRequest request = {fit.extent,
                                 fit.placement,
                                 SnapAll(fit, capped_->vertices),
                                 capped_->triangles,
                                 std::vector<int8_t>(capped_->triangles.size(), capped_->sign),
                                 options_.max_points};
    std::vector<GeneralizedWindingRule::Vector> lattice;
    for (const auto& vertex : capped_->vertices) lattice.push_back(fit.ToLattice(vertex));
    const GeneralizedWindingRule rule(lattice, capped_->caps, fit.extent, capped_->sign);
    return FillRows(request, rule, context_);
  }

  static std::vector<GridPoint> SnapAll(const GridFit& fit,
                                        std::span<const TriangleMesh::Vertex> vertices) {
    std::vector<GridPoint> snapped;
    snapped.reserve(vertices.size());
    for (const auto& vertex : vertices) snapped.push_back(fit.Snap(vertex));
    return snapped;
  }

  // Spacing for a first try: from the enclosed volume, or a coarse one from the box.
  double FirstSpacing(uint64_t target) const {
    if (surface_.report.closure == SurfaceClosure::kOriented && surface_.unit_volume > 0) {
      return std::cbrt(2 * surface_.unit_volume / static_cast<double>(target));
    }
    constexpr double kCoarseBoxPoints = 30000;
    const auto& box = surface_.upper_unit;
    return std::cbrt(2 * box[0] * box[1] * box[2] / kCoarseBoxPoints);
  }

  // Points = 2 * volume / spacing^3, so each count tells a better spacing.
  absl::StatusOr<Volume> FillToCount(uint64_t target) {
    constexpr int kTries = 12;
    constexpr double kTolerance = 0.02;
    constexpr double kFewPoints = 64;  // below, a count says little about the volume
    double spacing = FirstSpacing(target);
    Volume best;
    double best_ratio = 0;
    for (int n = 0; n < kTries; ++n) {
      BCCSKEL_ASSIGN_OR_RETURN(Volume volume, Fill(spacing));
      const auto count = static_cast<double>(volume.PointCount());
      const double ratio = count / static_cast<double>(target);
      if (Distance(ratio) < Distance(best_ratio)) {
        best = std::move(volume);
        best_ratio = ratio;
      }
      if (std::abs(ratio - 1) <= kTolerance) return best;
      spacing *= count < kFewPoints && ratio < 1 ? 0.5 : std::cbrt(ratio);
    }
    return BestOfTries(std::move(best), target);
  }

  // How far a count is from the target, as a factor of 1 or more.
  static double Distance(double ratio) { return ratio < 1 ? 1 / ratio : ratio; }

  absl::StatusOr<Volume> BestOfTries(Volume best, uint64_t target) {
    if (best.empty()) {
      return absl::InvalidArgumentError(
          "nothing enclosed: no lattice point is inside the mesh at any spacing tried");
    }
    warnings_.push_back(
        absl::StrFormat("%d points instead of the %d wanted", best.PointCount(), target));
    return best;
  }

  Surface surface_;
  std::optional<CappedSurface> capped_;
  const VoxelizeOptions& options_;
  const exec::Context& context_;
  FillRule rule_ = FillRule::kParity;
  std::vector<std::string> warnings_;
};

}  // namespace

absl::StatusOr<VoxelizeResult> Voxelize(const TriangleMesh& mesh, const VoxelizeOptions& options,
                                        const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckOptions(options));
  return Voxelizer(PrepareSurface(mesh), options, context).Run();
}

}  // namespace bccskel
