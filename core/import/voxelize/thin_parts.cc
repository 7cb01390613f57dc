#include "core/import/voxelize/thin_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/distance/places.h"
#include "core/exec/status_macros.h"
#include "core/import/voxelize/gather.h"
#include "core/import/voxelize/grid_fit.h"
#include "core/import/voxelize/needles.h"
#include "core/import/voxelize/slab_plan.h"
#include "core/import/voxelize/surface_sides.h"

namespace bccskel {
namespace {

constexpr double kOpposite = -0.8;    // cosine of the normals of the two sides, at most
constexpr double kLeastCosine = 0.5;  // of a normal and the row that crosses; an axis has 0.57
constexpr double kSmall = 4;  // lattice units: a larger triangle is not judged by its center
constexpr size_t kTrianglesAtOnce = 1 << 12;  // triangles
constexpr size_t kAxes = 3;

// Whether the solid may be thin behind the triangle.
bool MayBeThin(const SurfaceSides& sides, size_t triangle, NearbyBricks& bricks) {
  const auto [a, b, c] = sides.Corners(triangle);
  for (size_t axis = 0; axis < kAxes; ++axis) {
    const auto [low, high] = std::minmax({a[axis], b[axis], c[axis]});
    if (high - low > kSmall) return true;
  }
  const Coordinates normal = sides.Normal(triangle);
  const Coordinates center = Sum({0, 0, 0}, 1.0 / 3, Sum(Sum(a, 1, b), 1, c));
  return MayBeThinBehind(center, normal, bricks);
}

// Indices of the triangles behind which the solid may be thin.
std::vector<uint32_t> ThinTriangles(const SurfaceSides& sides, const Volume& sampling,
                                    const exec::Context& context) {
  return Gather<uint32_t>(sides.size(), kTrianglesAtOnce, context, [&] {
    return [&, bricks = NearbyBricks(sampling)](size_t t, std::vector<uint32_t>& thin) mutable {
      if (MayBeThin(sides, t, bricks)) thin.push_back(static_cast<uint32_t>(t));
    };
  });
}

// The thin triangles with one of the axes turned to x, as rays run along x only.
class TurnedSides {
 public:
  TurnedSides(const FillRequest& request, const SurfaceSides& sides, std::span<const uint32_t> thin,
              size_t axis)
      : axis_(axis) {
    const LatticeExtent& e = request.extent;
    const std::array<int32_t, kAxes> cells = {e.nx, e.ny, e.nz};
    turned_.extent = {cells[axis], cells[(axis + 1) % kAxes], cells[(axis + 2) % kAxes]};
    for (const uint32_t t : thin) {
      const Coordinates normal = sides.Normal(t);
      if (std::abs(normal[axis]) < kLeastCosine) continue;  // another axis meets it more squarely
      TriangleMesh::Triangle triangle;
      for (size_t n = 0; n < triangle.size(); ++n) {
        triangle[n] = static_cast<uint32_t>(turned_.vertices.size());
        turned_.vertices.push_back(Turned(request.vertices[request.triangles[t][n]]));
      }
      triangles_.push_back(triangle);
      normals_.push_back(normal);
      turned_.sign.push_back(request.sign[t]);
    }
    turned_.triangles = triangles_;
  }

  // Needs: before Append(). Errors: RESOURCE_EXHAUSTED (too many rows or crossings).
  absl::Status Plan() {
    BCCSKEL_RETURN_IF_ERROR(CheckCrossingWork(turned_, 0));
    plan_.emplace(turned_);
    return absl::OkStatus();
  }

  size_t slabs() const { return plan_->size(); }

  // Appends the lattice points that thin parts in the slab need.
  void Append(size_t slab, std::vector<LatticePoint>& points) const {
    std::vector<RowHit> hits;
    for (const uint32_t t : plan_->triangles(slab)) AppendHits(turned_, t, plan_->slab(slab), hits);
    std::ranges::sort(hits, [](const RowHit& a, const RowHit& b) {
      return std::tie(a.row, a.x, a.triangle) < std::tie(b.row, b.x, b.triangle);
    });
    for (size_t n = 0; n + 1 < hits.size(); ++n) AppendBetween(hits[n], hits[n + 1], points);
  }

 private:
  GridPoint Turned(const GridPoint& p) const {
    const std::array<int64_t, kAxes> at = {p.x, p.y, p.z};
    return {at[axis_], at[(axis_ + 1) % kAxes], at[(axis_ + 2) % kAxes]};
  }
  LatticePoint Back(int32_t x, int32_t y, int32_t z) const {
    std::array<int32_t, kAxes> at;
    at[axis_] = x, at[(axis_ + 1) % kAxes] = y, at[(axis_ + 2) % kAxes] = z;
    return {at[0], at[1], at[2]};
  }

  // Appends the points near the middle between the hits if the part between them is thin.
  void AppendBetween(const RowHit& in, const RowHit& out, std::vector<LatticePoint>& points) const {
    if (in.row != out.row || in.winding <= 0 || out.winding >= 0) return;
    const Coordinates &before = normals_[in.triangle], &behind = normals_[out.triangle];
    if (Dot(before, behind) > kOpposite) return;
    const double cosine = (std::abs(before[axis_]) + std::abs(behind[axis_])) / 2;
    const double from = static_cast<double>(in.x) / kTicksPerUnit;
    const double to = static_cast<double>(out.x) / kTicksPerUnit;
    const double thickness = (to - from) * cosine;
    if (thickness < kLeastThickness || thickness >= kLeastResolved) return;
    const double middle = (from + to) / 2, reach = kLeastResolved / 2 / cosine;
    const LatticeRow row = in.row.row();
    const auto odd = static_cast<int32_t>(row.sublattice);
    const auto first = static_cast<int32_t>(std::ceil((middle - reach - odd) / 2));
    for (int32_t x = 2 * first + odd; x <= middle + reach; x += 2) {
      points.push_back(Back(x, 2 * row.j + odd, 2 * row.k + odd));
    }
  }

  const size_t axis_;
  FillRequest turned_;
  std::vector<TriangleMesh::Triangle> triangles_;
  std::vector<Coordinates> normals_;  // not turned
  std::optional<SlabPlan> plan_;
};

// The points that the thin triangles need, in no order, some more than once.
absl::StatusOr<std::vector<LatticePoint>> MissingPoints(const FillRequest& request,
                                                        const SurfaceSides& sides,
                                                        std::span<const uint32_t> thin,
                                                        const exec::Context& context) {
  std::vector<TurnedSides> turned;
  std::vector<std::pair<size_t, size_t>> tasks;  // axis and slab
  turned.reserve(kAxes);
  for (size_t axis = 0; axis < kAxes; ++axis) {
    turned.emplace_back(request, sides, thin, axis);
    BCCSKEL_RETURN_IF_ERROR(turned[axis].Plan());
    for (size_t slab = 0; slab < turned[axis].slabs(); ++slab) tasks.emplace_back(axis, slab);
  }
  return Gather<LatticePoint>(tasks.size(), 1, context, [&] {
    return [&](size_t task, std::vector<LatticePoint>& points) {
      turned[tasks[task].first].Append(tasks[task].second, points);
    };
  });
}

}  // namespace

absl::StatusOr<Volume> WithThinParts(Volume sampling, const FillRequest& request, size_t triangles,
                                     const exec::Context& context) {
  const SurfaceSides sides(request, triangles);
  const std::vector<uint32_t> thin = ThinTriangles(sides, sampling, context);
  BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
  if (thin.empty()) return sampling;
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<LatticePoint> missing,
                           MissingPoints(request, sides, thin, context));
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<LatticePoint> of_needles,
                           NeedlePoints(sides, thin, sampling, context));
  missing.insert(missing.end(), of_needles.begin(), of_needles.end());
  BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
  std::erase_if(missing, [&](LatticePoint p) {
    return !sampling.extent().Contains(p) || sampling.Contains(p);
  });
  if (missing.empty()) return sampling;
  VolumeBuilder builder(sampling.extent(), sampling.placement());
  for (size_t n = 0; n < sampling.brick_count(); ++n) {
    builder.Brick(sampling.keys()[n]) = sampling.bricks()[n];
  }
  for (const LatticePoint p : missing) builder.Add(p);
  BCCSKEL_ASSIGN_OR_RETURN(Volume whole, std::move(builder).Build());
  if (whole.PointCount() <= request.max_points) return whole;
  return absl::ResourceExhaustedError(absl::StrFormat(
      "the solid has more than the limit of %d lattice points", request.max_points));
}

}  // namespace bccskel
