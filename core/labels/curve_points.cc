#include "core/labels/curve_points.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

using Vector = std::array<double, 3>;

double Determinant(const Vector& a, const Vector& b, const Vector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// The components of `v` along the columns of the direction matrix, by Cramer's rule.
absl::StatusOr<Vector> AlongAxes(const std::array<double, 9>& m, const Vector& v) {
  const Vector x = {m[0], m[3], m[6]}, y = {m[1], m[4], m[7]}, z = {m[2], m[5], m[8]};
  const double all = Determinant(x, y, z);
  if (!(std::abs(all) > 1e-9)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the direction matrix has determinant %g: it has no inverse", all));
  }
  return Vector{Determinant(v, y, z) / all, Determinant(x, v, z) / all, Determinant(x, y, v) / all};
}

// Lattice point p of an axis lies at first + step * p on the grid, in voxels.
struct LatticeOnGrid {
  Vector first;
  Vector step;

  Vector At(LatticePoint p) const {
    return {first[0] + step[0] * p.x, first[1] + step[1] * p.y, first[2] + step[2] * p.z};
  }
};

absl::StatusOr<LatticeOnGrid> PlaceOnGrid(const Placement& lattice, const Placement& grid) {
  Vector offset = {};
  for (size_t axis = 0; axis < 3; ++axis) offset[axis] = lattice.origin[axis] - grid.origin[axis];
  LatticeOnGrid placed;
  BCCSKEL_ASSIGN_OR_RETURN(placed.first, AlongAxes(grid.direction, offset));
  // The exact conversion puts points midway between voxels: what rounding made of that is undone.
  constexpr double kSteps = 1 << 20;
  for (size_t axis = 0; axis < 3; ++axis) {
    placed.first[axis] = std::round(placed.first[axis] / grid.spacing[axis] * kSteps) / kSteps;
    placed.step[axis] = lattice.spacing[axis] / grid.spacing[axis] / 2;
  }
  return placed;
}

struct ValuedPoint {
  LatticePoint point;
  uint32_t value;
};

std::vector<ValuedPoint> ValuedPoints(const SkeletonGraph& graph) {
  std::vector<ValuedPoint> points;
  std::vector<bool> touched(graph.nodes.size());
  for (size_t e = 0; e < graph.edges.size(); ++e) {
    const SkeletonEdge& edge = graph.edges[e];
    touched[edge.source] = touched[edge.target] = true;
    for (const SkeletonPoint& p : graph.PointsOf(edge)) {
      points.push_back({p.point, static_cast<uint32_t>(e + 1)});
    }
  }
  for (size_t n = 0; n < graph.nodes.size(); ++n) {
    if (touched[n]) continue;
    points.push_back({graph.nodes[n].at.point, static_cast<uint32_t>(graph.edges.size() + n + 1)});
  }
  return points;
}

// Half a voxel around the point, and one voxel around it for samplings.
constexpr std::array<double, 2> kReaches = {0.5, 1};

using FoundVoxel = std::pair<std::array<int32_t, 3>, RunIndex>;

// The first of the object's voxels whose centers are at most the smallest reach that finds one away
// from both places, along each axis.
std::optional<FoundVoxel> FirstVoxel(const Vector& a, const Vector& b, const RunLookup& lookup) {
  for (double reach : kReaches) {
    std::array<int32_t, 3> low = {}, high = {};
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = static_cast<int32_t>(std::ceil(std::max(a[axis], b[axis]) - reach));
      high[axis] = static_cast<int32_t>(std::floor(std::min(a[axis], b[axis]) + reach));
    }
    for (int32_t z = low[2]; z <= high[2]; ++z) {
      for (int32_t y = low[1]; y <= high[1]; ++y) {
        for (int32_t x = low[0]; x <= high[0]; ++x) {
          if (const auto run = lookup.Find({x, y, z})) return std::pair{std::array{x, y, z}, *run};
        }
      }
    }
  }
  return std::nullopt;
}

std::array<int32_t, 3> NearestOfGrid(const Vector& at, const MaskGrid& grid) {
  const std::array<int32_t, 3> size = {grid.nx, grid.ny, grid.nz};
  std::array<int32_t, 3> voxel = {};
  for (size_t axis = 0; axis < 3; ++axis) {
    voxel[axis] = static_cast<int32_t>(std::clamp(std::round(at[axis]), 0.0, size[axis] - 1.0));
  }
  return voxel;
}

}  // namespace

absl::StatusOr<std::vector<CurvePoint>> CurvePointsOf(const SkeletonGraph& graph,
                                                      const MaskGrid& grid,
                                                      const RunLookup& lookup) {
  BCCSKEL_ASSIGN_OR_RETURN(const LatticeOnGrid placed,
                           PlaceOnGrid(graph.placement, grid.placement));
  std::vector<CurvePoint> points;
  for (const auto& [point, value] : ValuedPoints(graph)) {
    const Vector at = placed.At(point);
    if (const auto found = FirstVoxel(at, at, lookup)) {
      points.push_back({at, found->first, found->second, value});
    }
  }
  return points;
}

absl::StatusOr<std::vector<std::array<int32_t, 3>>> NodeVoxels(const SkeletonGraph& graph,
                                                               const MaskGrid& grid,
                                                               const RunLookup& lookup) {
  BCCSKEL_ASSIGN_OR_RETURN(const LatticeOnGrid placed,
                           PlaceOnGrid(graph.placement, grid.placement));
  std::vector<std::array<int32_t, 3>> voxels;
  voxels.reserve(graph.nodes.size());
  for (const SkeletonNode& node : graph.nodes) {
    const Vector at = placed.At(node.at.point);
    const auto found = FirstVoxel(at, at, lookup);
    voxels.push_back(found.has_value() ? found->first : NearestOfGrid(at, grid));
  }
  return voxels;
}

std::optional<std::array<int32_t, 3>> SharedVoxel(const CurvePoint& a, const CurvePoint& b,
                                                  const RunLookup& lookup) {
  const auto found = FirstVoxel(a.at, b.at, lookup);
  return found ? std::optional(found->first) : std::nullopt;
}

}  // namespace bccskel
