#include "core/import/voxelize/voxelize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/voxelize/crossings.h"
#include "core/import/voxelize/grid_fit.h"
#include "core/import/voxelize/shape_axes.h"
#include "core/import/voxelize/solid_fill.h"
#include "core/import/voxelize/topology_repair.h"

namespace bccskel {
namespace {

std::string Counted(int64_t count, const char* one, const char* many) {
  return absl::StrFormat("%d %s", count, count == 1 ? one : many);
}

std::string InWords(const SolidTopology& solid) {
  return Counted(solid.components, "component", "components") + ", " +
         Counted(solid.loops, "loop", "loops") + ", " +
         Counted(solid.cavities, "cavity", "cavities");
}

SolidTopology AsSolid(const BettiNumbers& grid) {
  return {grid.components, grid.loops, grid.cavities};
}

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

absl::Status CheckCell(const Surface& surface, double spacing) {
  const auto& [x, y, z] = surface.upper_unit;
  const double unit = 2 * surface.half_size;
  if (spacing <= std::max({x, y, z}) * unit) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat(
      "spacing %g: a cell is larger than the mesh, whose box is %.4g x %.4g x %.4g; use a smaller "
      "--spacing, or --points",
      spacing, x * unit, y * unit, z * unit));
}

// Looks for the spacing that gives a number of points.
class SpacingSearch {
 public:
  explicit SpacingSearch(double first) : spacing_(first) {}

  double spacing() const { return spacing_; }

  // Takes the count found at spacing() and moves on: by the law of cubes, or to the middle of the
  // bracket when that has been left or makes no progress.
  void Learn(uint64_t count, uint64_t target) {
    (count > target ? too_small_ : too_large_) = spacing_;
    const double ratio = static_cast<double>(count) / static_cast<double>(target);
    constexpr uint64_t kFewPoints = 64;  // below, a count says little about the volume
    const double next = spacing_ * (count < kFewPoints && ratio < 1 ? 0.5 : std::cbrt(ratio));
    const bool bracketed = too_small_ > 0 && std::isfinite(too_large_);
    const bool inside = next > too_small_ && next < too_large_;
    spacing_ = bracketed && (!inside || ++steps_in_bracket_ > 2)
                   ? std::sqrt(too_small_) * std::sqrt(too_large_)
                   : next;
  }

 private:
  double spacing_;
  double too_small_ = 0;
  double too_large_ = std::numeric_limits<double>::infinity();
  int steps_in_bracket_ = 0;
};

class Voxelizer {
 public:
  // `axes`: those of the lattice, along which the surface is given; null: the world's.
  Voxelizer(Surface surface, const ShapeAxes* axes, const VoxelizeOptions& options,
            const exec::Context& context)
      : surface_(std::move(surface)), axes_(axes), options_(options), context_(context) {}

  absl::StatusOr<VoxelizeResult> Run() {
    BCCSKEL_RETURN_IF_ERROR(CheckTriangles(surface_));
    VoxelizeResult result;
    BCCSKEL_ASSIGN_OR_RETURN(result.fill, ChooseFillRule(surface_.report, options_.fill));
    BCCSKEL_RETURN_IF_ERROR(CheckSize(surface_));
    warnings_ = DefectWarnings(surface_.report, result.fill);
    const bool chosen = options_.spacing && options_.large_cells == LargeCells::kRefuse;
    if (chosen) BCCSKEL_RETURN_IF_ERROR(CheckCell(surface_, *options_.spacing));
    fill_.emplace(surface_, result.fill, options_.max_points);
    BCCSKEL_ASSIGN_OR_RETURN(Sampling sampling, FillAsAsked());
    const uint64_t inside = sampling.volume.PointCount();
    WarnOfCancelledVolume(sampling.volume);
    if (options_.thin_parts == ThinParts::kKeep) {
      BCCSKEL_ASSIGN_OR_RETURN(sampling.volume, fill_->KeepThinParts(std::move(sampling.volume),
                                                                     sampling.request, context_));
    }
    result.volume = std::move(sampling.volume);
    if (result.volume.empty()) {
      warnings_.push_back("no lattice point is inside: the spacing is too large for this mesh");
    } else if (chosen) {
      WarnOfFewPoints(*options_.spacing);
    }
    result.added_points = result.volume.PointCount() - inside;
    if (options_.topology == TopologyCheck::kCompare && !result.volume.empty()) {
      BCCSKEL_ASSIGN_OR_RETURN(result.topology, CountBettiNumbers(result.volume, context_));
      BCCSKEL_RETURN_IF_ERROR(CompareTopology(result));
    }
    result.warnings = std::move(warnings_);
    result.mesh = std::move(surface_.report);
    return result;
  }

  // Whether the volume has another topology than the mesh.
  bool misses_topology() const { return misses_topology_; }

 private:
  // The lattice points inside on one grid.
  struct Sampling {
    FillRequest request;
    Volume volume;
  };

  absl::StatusOr<Sampling> FillAsAsked() {
    if (!options_.spacing) return FillToCount(*options_.points);
    const double unit_spacing = *options_.spacing / surface_.half_size / 2;
    return Fill(unit_spacing, options_.shift);
  }

  // The points that keep thin parts hide that so few are inside.
  void WarnOfFewPoints(double spacing) {
    constexpr double kFew = 16;
    const double unit_spacing = spacing / surface_.half_size / 2;
    const double points = 2 * surface_.unit_volume / unit_spacing / unit_spacing / unit_spacing;
    if (surface_.report.closure != SurfaceClosure::kOriented || !(points < kFew)) return;
    warnings_.push_back(absl::StrFormat(
        "a spacing of %g leaves about %.2g lattice points to the volume of the mesh, too few for "
        "its shape; use a smaller --spacing, or --points",
        spacing, points));
  }

  // Holes change the signed volume, too, but by far less than parts that turn against each other.
  void WarnOfCancelledVolume(const Volume& inside) {
    const double spacing = inside.placement().spacing[0];
    const double filled =
        static_cast<double>(inside.PointCount()) * spacing * spacing * spacing / 2;
    const double enclosed = std::abs(surface_.report.volume);
    if (surface_.report.closure != SurfaceClosure::kOpen || !(enclosed < filled / 4)) return;
    warnings_.push_back(
        absl::StrFormat("parts of the mesh turn against each other: its signed volume is %.3g, but "
                        "%.3g is filled, and parts that face inward are left out; turn their "
                        "triangles around, or close the mesh",
                        enclosed, filled));
  }

  // Repairs the topology, or warns about it.
  absl::Status CompareTopology(VoxelizeResult& result) {
    const SolidTopology found = AsSolid(*result.topology);
    if (surface_.report.closure == SurfaceClosure::kOpen) {
      WarnOfUnknownTopology("an open mesh", found, result.volume);
      return absl::OkStatus();
    }
    const std::optional<SolidTopology> mesh = ExpectedTopology(surface_.report, result.fill);
    if (mesh == found) return absl::OkStatus();
    if (mesh) BCCSKEL_RETURN_IF_ERROR(Repair(*mesh, result));
    if (mesh == AsSolid(*result.topology)) return absl::OkStatus();
    BCCSKEL_ASSIGN_OR_RETURN(const CrossingCount crossings, CountCrossings(surface_, context_));
    if (!mesh) {
      if (crossings.total() > 0) WarnOfUnknownTopology("a crossing mesh", found, result.volume);
      return absl::OkStatus();
    }
    const bool is_union = crossings.within_parts == 0 && crossings.between_parts > 0 &&
                          result.fill == FillRule::kWinding;
    misses_topology_ = !is_union;
    warnings_.push_back(
        "the volume has " + InWords(AsSolid(*result.topology)) + ", but the mesh has " +
        InWords(*mesh) + ": " +
        (is_union ? "its parts overlap, and the volume is their union"
                  : CauseInWords(crossings.total(), result.volume) +
                        TunnelsInWords(result.topology->loops - mesh->loops, result.volume)));
    return absl::OkStatus();
  }

  void WarnOfUnknownTopology(const char* of, const SolidTopology& found, const Volume& volume) {
    warnings_.push_back("the volume has " + InWords(found) + "; the topology of " + of +
                        " is not known: check these numbers" +
                        (found.components > 1 ? " (--join-gaps X joins components)" : "") +
                        TunnelsInWords(found.loops, volume));
  }

  // Seams between parts that touch or cross, such as cushions, make rows of tunnels.
  static std::string TunnelsInWords(int64_t loops, const Volume& volume) {
    constexpr int64_t kMany = 8;
    constexpr double kCells = 3;
    if (loops < kMany) return "";
    return absl::StrFormat("; --cut-loops %.2g closes tunnels narrower than three cells",
                           kCells * volume.placement().spacing[0]);
  }

  std::string CauseInWords(uint64_t crossings, const Volume& volume) const {
    if (crossings == 0) {
      return "walls or gaps are thinner than a cell, which more points or a smaller spacing "
             "resolve, or parts touch or coincide, which only a change of the mesh resolves" +
             WallsInWords(volume);
    }
    return Counted(static_cast<int64_t>(crossings), "pair of triangles crosses",
                   "pairs of triangles cross") +
           "; repair the mesh; --denoise 1, which removes thin spots and small holes, may help";
  }

  // Where it is near a cell or below, what would resolve the mean thickness of walls, which is
  // twice the volume by the area; "" elsewhere.
  std::string WallsInWords(const Volume& volume) const {
    double area = 0;
    for (const auto& [a, b, c] : surface_.triangles) {
      const WorldPoint& at = surface_.vertices[a];
      area += LengthOf(Cross(Minus(surface_.vertices[b], at), Minus(surface_.vertices[c], at))) / 2;
    }
    const double thickness = 2 * surface_.unit_volume / area;
    const double cell = volume.placement().spacing[0] / surface_.half_size / 2;
    if (!(thickness > 0 && thickness < 2 * cell)) return "";
    const double spacing = thickness / 2;
    const double points = 2 * surface_.unit_volume / (spacing * spacing * spacing);
    // Where parts that turn against each other cancel out, the mean says nothing.
    if (points > static_cast<double>(options_.max_points)) return "";
    return absl::StrFormat(
        "; walls are about %.2g thick and cells %.2g wide, so try --spacing %.2g, which takes "
        "about %.2g points",
        InWorld(thickness), InWorld(cell), InWorld(spacing), points);
  }
  double InWorld(double length) const { return length * surface_.half_size * 2; }

  absl::Status Repair(const SolidTopology& mesh, VoxelizeResult& result) {
    const BettiNumbers wanted = {mesh.components, mesh.loops, mesh.cavities};
    BCCSKEL_ASSIGN_OR_RETURN(Volume repaired, RepairTopology(std::move(result.volume),
                                                             *result.topology, wanted, context_));
    result.volume = std::move(repaired);
    BCCSKEL_ASSIGN_OR_RETURN(result.topology, CountBettiNumbers(result.volume, context_));
    return absl::OkStatus();
  }

  absl::StatusOr<Sampling> Fill(double unit_spacing, GridShift shift) const {
    Sampling sampling;
    BCCSKEL_ASSIGN_OR_RETURN(GridFit fit, FitGrid(surface_, unit_spacing, shift));
    if (axes_ != nullptr) {
      fit.placement = axes_->ToWorld(fit.placement);
      BCCSKEL_RETURN_IF_ERROR(CheckPlacement(fit.placement));
    }
    sampling.request = fill_->RequestOn(fit);
    BCCSKEL_ASSIGN_OR_RETURN(sampling.volume, fill_->Fill(sampling.request, context_));
    return sampling;
  }

  // Spacing that gives about this many points in the box.
  double BoxSpacing(double points) const {
    const auto& box = surface_.upper_unit;
    return std::cbrt(2 * box[0] * box[1] * box[2] / points);
  }

  // Spacing for a first try: from the enclosed volume, or a coarse one from the box. Where parts of
  // a surface turn against each other their volumes cancel, and the spacing that follows from the
  // sum may ask for any number of points; so a small sum is compared with a coarse grid first.
  absl::StatusOr<double> FirstSpacing(uint64_t target) const {
    constexpr double kCoarseBoxPoints = 30000;
    constexpr double kLargeShare = 1.0 / 8;
    const auto& box = surface_.upper_unit;
    const double coarse = BoxSpacing(kCoarseBoxPoints);
    const double share = surface_.unit_volume / (box[0] * box[1] * box[2]);
    if (surface_.report.closure != SurfaceClosure::kOriented || !(share > 0)) return coarse;
    const double spacing = std::cbrt(2 * surface_.unit_volume / static_cast<double>(target));
    if (share >= kLargeShare) return spacing;
    BCCSKEL_ASSIGN_OR_RETURN(const Sampling tried, Fill(coarse, GridShift::kCentered));
    const double expected = kCoarseBoxPoints * share;
    const bool plausible = expected >= 1 && static_cast<double>(tried.volume.PointCount()) <=
                                                8 * std::max(expected, 4.0);
    return plausible ? spacing : coarse;
  }

  // At this spacing the volume asks for far more points than wanted. Fewer are found where flat
  // walls lie between the layers of points; finer grids then find none, and at once too many.
  double LeastSpacing(uint64_t target) const {
    constexpr double kFarMore = 512;
    if (surface_.report.closure != SurfaceClosure::kOriented) return 0;
    return std::cbrt(2 * std::max(surface_.unit_volume, 0.0) /
                     (kFarMore * static_cast<double>(target)));
  }

  // Points = 2 * volume / spacing^3, so each count gives a better spacing. The count jumps where
  // flat walls cross whole layers of points; the second half of the tries moves the grid off the
  // middle, where opposite walls jump at different spacings.
  absl::StatusOr<Sampling> FillToCount(uint64_t target) {
    constexpr int kTries = 16;
    // A surface folded onto itself encloses no point, ever. In an open one each row near a hole is
    // slow, so a file of three triangles took minutes.
    const int fruitless_tries = surface_.report.closure == SurfaceClosure::kOpen ? 4 : 7;
    constexpr double kTolerance = 0.02;
    BCCSKEL_ASSIGN_OR_RETURN(const double first, FirstSpacing(target));
    const double least = LeastSpacing(target);
    SpacingSearch search(first);
    Sampling best;
    double best_ratio = 0;
    for (int n = 0; n < kTries; ++n) {
      if (n == kTries / 2) search = SpacingSearch(search.spacing());
      const GridShift shift = n < kTries / 2 ? GridShift::kCentered : GridShift::kOffCenter;
      if (n == fruitless_tries && best.volume.empty()) break;
      if (search.spacing() < least) break;
      BCCSKEL_ASSIGN_OR_RETURN(Sampling tried, Fill(search.spacing(), shift));
      const uint64_t count = tried.volume.PointCount();
      const double ratio = static_cast<double>(count) / static_cast<double>(target);
      if (Distance(ratio) < Distance(best_ratio)) {
        best = std::move(tried);
        best_ratio = ratio;
      }
      if (std::abs(best_ratio - 1) <= kTolerance) return best;
      search.Learn(count, target);
    }
    return BestOfTries(std::move(best), target);
  }

  // How far a count is from the target, as a factor of 1 or more.
  static double Distance(double ratio) { return ratio < 1 ? 1 / ratio : ratio; }

  absl::StatusOr<Sampling> BestOfTries(Sampling best, uint64_t target) {
    if (best.volume.empty()) {
      const bool parity = fill_->rule() == FillRule::kParity;
      return absl::InvalidArgumentError(absl::StrCat(
          "nothing enclosed: no lattice point is inside the mesh at any spacing tried; ",
          parity ? "by parity, a part that is there twice vanishes, so remove the copies or use "
                   "--fill winding"
                 : "it is far thinner than a cell, so use more --points, or its walls lie on each "
                   "other, so give them a thickness"));
    }
    warnings_.push_back(
        absl::StrFormat("%d points instead of the %d wanted", best.volume.PointCount(), target));
    return best;
  }

  Surface surface_;
  const ShapeAxes* const axes_;
  std::optional<SolidFill> fill_;
  const VoxelizeOptions& options_;
  const exec::Context& context_;
  std::vector<std::string> warnings_;
  bool misses_topology_ = false;
};

}  // namespace

absl::StatusOr<VoxelizeResult> Voxelize(const TriangleMesh& mesh, const VoxelizeOptions& options,
                                        const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckOptions(options));
  Surface surface = PrepareSurface(mesh);
  std::vector<ShapeAxes> choices;
  if (options.axes == LatticeAxes::kShape) choices = ShapeAxesOf(surface);
  if (choices.empty()) return Voxelizer(std::move(surface), nullptr, options, context).Run();
  VoxelizeResult first;
  for (const ShapeAxes& axes : choices) {
    Voxelizer voxelizer(axes.Along(surface), &axes, options, context);
    BCCSKEL_ASSIGN_OR_RETURN(VoxelizeResult result, voxelizer.Run());
    if (!voxelizer.misses_topology()) return result;
    if (&axes == &choices.front()) first = std::move(result);
  }
  return first;
}

}  // namespace bccskel
