#include "core/skeleton/voxel_radii.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/distance/exact_radius.h"
#include "core/distance/places.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

using Vector = std::array<double, 3>;
using Voxel = std::array<int32_t, 3>;

constexpr int kStepsPerVoxel = 4;
// How much farther, in voxels, the other side of a point near the middle may be.
constexpr double kMostFarther = 1.5;
// In voxels: what the nearest background lies outside of any round object, and what more it does
// divided by the radius. Measured on balls and cylinders of 1 to 8.5 voxels.
constexpr double kOutside = 0.1;
constexpr double kOutsideSmall = 0.2;

class VoxelRadii {
 public:
  VoxelRadii(const Volume& object, int32_t voxel_units, const ExactRadius& search)
      : voxel_(voxel_units),
        per_unit_(1.0 / voxel_units),
        scale_(AxisScaleOf(object.placement())),
        window_(object.window()),
        search_(search),
        bricks_(object) {}

  // `radius` is the distance of p to the nearest background point.
  float At(LatticePoint p, float radius) {
    if (radius == 0) return 0;
    Vector way = WayTo(p, search_.FirstNearestAt(p, radius));
    Vector from = {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
    double near;
    if (const std::optional<size_t> axis = FlatAcross(p, way)) {
      near = FaceAlong(p, way, *axis);
      // Through the middle of the voxels there: p may lie where four of them meet.
      for (size_t a = 0; a < 3; ++a) {
        if (a == *axis) continue;
        from[a] += way[a];
        way[a] = 0;
      }
    } else {
      near = NearRoundSide(way);
    }
    const double far = FarSide(from, way, near);
    // Where voxels meet in an edge or a corner there is no thickness; no mask shows thinner parts.
    const double half_edge = voxel_ / 2.0;  // of the shortest
    return static_cast<float>(std::max((near + far) / 2, half_edge));
  }

 private:
  // To the center of the voxel that q is in, unless q is a corner.
  Vector WayTo(LatticePoint p, LatticePoint q) const {
    const std::array<int32_t, 3> from = {p.x, p.y, p.z}, to = {q.x, q.y, q.z};
    Vector way;
    for (size_t a = 0; a < 3; ++a) {
      const double voxel = FloorOf(static_cast<double>(to[a]) / voxel_);
      const double at = SublatticeOf(q) == Sublattice::kOdd ? voxel_ * (voxel + 0.5) : to[a];
      way[a] = at - from[a];
    }
    return way;
  }
  static double Norm(const Vector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
  double LengthOf(const Vector& way) const {
    return Norm({scale_[0] * way[0], scale_[1] * way[1], scale_[2] * way[2]});
  }
  // How long a voxel is in this direction.
  double VoxelAlong(const Vector& way) const { return voxel_ * LengthOf(way) / Norm(way); }

  bool IsObject(const Voxel& v) {
    return bricks_.Contains({voxel_ * v[0] + 1, voxel_ * v[1] + 1, voxel_ * v[2] + 1});
  }
  Voxel VoxelAt(const Vector& at) const {
    Voxel v;
    for (size_t a = 0; a < 3; ++a) v[a] = FloorOf(at[a] * per_unit_);
    return v;
  }

  // The axis across which the surface on the side of the nearest background point is a plane.
  std::optional<size_t> FlatAcross(LatticePoint p, const Vector& way) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      if (2 * std::max(std::abs(way[u]), std::abs(way[v])) > voxel_) continue;
      if (IsFlat(p, way, axis)) return axis;
    }
    return std::nullopt;
  }

  // The distance to a round surface on the side of the nearest background point: the nearest of the
  // voxels around lies a little outside on average, the more the fewer there are.
  double NearRoundSide(const Vector& way) const {
    const double length = LengthOf(way), voxel = VoxelAlong(way);
    return std::max(length - voxel * (kOutside + kOutsideSmall * voxel / length), 0.0);
  }

  // From p to the face of the last object voxel along the axis.
  double FaceAlong(LatticePoint p, const Vector& way, size_t axis) const {
    const std::array<int32_t, 3> from = {p.x, p.y, p.z};
    const double to = from[axis] + way[axis];
    const double index = std::floor(to / voxel_);
    const double face = voxel_ * (way[axis] > 0 ? index : index + 1);
    return scale_[axis] * std::abs(face - from[axis]);
  }

  // Whether the surface there is a plane across the axis, wider than the terrace that a round
  // object of this radius has.
  bool IsFlat(LatticePoint p, const Vector& way, size_t axis) {
    const Voxel outside = VoxelAt({p.x + way[0], p.y + way[1], p.z + way[2]});
    const int32_t inward = way[axis] > 0 ? -1 : 1;
    const double voxels = std::abs(way[axis]) / voxel_;
    const auto wide = static_cast<int32_t>(std::ceil(std::sqrt(2 * voxels)));
    for (size_t lateral = 0; lateral < 3; ++lateral) {
      if (lateral == axis) continue;
      for (int32_t step : {-wide, -1, 0, 1, wide}) {
        Voxel v = outside;
        v[lateral] += step;
        if (IsBeyondImage(v)) continue;
        if (IsObject(v)) return false;
        v[axis] += inward;
        if (!IsObject(v)) return false;
      }
    }
    return true;
  }

  // What lies beyond the border of an image that continues is unknown.
  bool IsBeyondImage(const Voxel& v) const {
    const LatticePoint middle = {voxel_ * v[0] + 1, voxel_ * v[1] + 1, voxel_ * v[2] + 1};
    return window_.has_value() && !window_->Contains(middle);
  }

  // The distance to the face where the chord leaves the object on the other side.
  double FarSide(const Vector& from, const Vector& way, double near) {
    const double length = LengthOf(way), voxel = VoxelAlong(way), step = voxel / kStepsPerVoxel;
    const double begin = std::max(near - voxel, 0.0);
    const auto steps = static_cast<int>((near + kMostFarther * voxel - begin) / step);
    Voxel passed = {-1, -1, -1};  // no voxel
    for (int n = 0; n < steps; ++n) {
      const double along = (begin + (n + 0.5) * step) / length;
      const Vector at = {from[0] - along * way[0], from[1] - along * way[1],
                         from[2] - along * way[2]};
      const Voxel voxel_here = VoxelAt(at);
      if (voxel_here == passed) continue;
      if (!IsObject(voxel_here)) return begin + n * step;
      passed = voxel_here;
    }
    return near;
  }

  const int32_t voxel_;
  const double per_unit_;  // voxels in one, exact for the powers of two that voxels have
  const AxisScale scale_;
  const std::optional<LatticeBox> window_;
  ExactRadius search_;
  NearbyBricks bricks_;
};

}  // namespace

absl::StatusOr<std::vector<float>> MeasureVoxelRadii(const Volume& object, int32_t voxel_units,
                                                     const ExactRadius& search, const Volume& thin,
                                                     std::span<const float> exact,
                                                     const exec::Context& context) {
  std::vector<LatticePoint> points;
  thin.ForEachPoint([&](LatticePoint p) { points.push_back(p); });
  std::vector<float> measured(points.size());
  constexpr size_t kWork = 32;  // as for ExactRadii()
  const int workers = context.WorkersFor(points.size(), kWork);
  BCCSKEL_RETURN_IF_ERROR(context.ForEach(workers, points.size(), 64, [&](int) {
    return [&, radii = VoxelRadii(object, voxel_units, search)](size_t n) mutable {
      measured[n] = radii.At(points[n], exact[n]);
    };
  }));
  return measured;
}

}  // namespace bccskel
