#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_SURFACE_SIDES_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_SURFACE_SIDES_H_

#include <array>
#include <cstddef>

#include "core/distance/places.h"
#include "core/import/voxelize/grid_fit.h"
#include "core/import/voxelize/row_fill.h"

namespace bccskel {

inline constexpr double kTicksPerUnit = 1 << kTickBits;

// Lattice units: the lattice resolves parts at least this thick; see thin_parts.h.
inline constexpr double kLeastResolved = 2;

// Lattice units: thinner surfaces are folded onto themselves and enclose nothing.
inline constexpr double kLeastThickness = 1 / 16.0;

// The triangles of a surface on the lattice, in lattice units.
class SurfaceSides {
 public:
  // Needs: `request` outlives this. `triangles`: how many of its triangles, from the first, belong
  //        to the surface.
  SurfaceSides(const FillRequest& request, size_t triangles)
      : request_(request), triangles_(triangles) {}

  size_t size() const { return triangles_; }
  std::array<Coordinates, 3> Corners(size_t triangle) const {
    std::array<Coordinates, 3> corners;
    for (size_t n = 0; n < corners.size(); ++n) {
      const GridPoint& p = request_.vertices[request_.triangles[triangle][n]];
      corners[n] = {static_cast<double>(p.x) / kTicksPerUnit,
                    static_cast<double>(p.y) / kTicksPerUnit,
                    static_cast<double>(p.z) / kTicksPerUnit};
    }
    return corners;
  }
  // The outward normal, of length 1; 0 if the triangle has no area.
  Coordinates Normal(size_t triangle) const {
    const auto [a, b, c] = Corners(triangle);
    const Coordinates normal = Cross(Sum(b, -1, a), Sum(c, -1, a));
    const double length = LengthOf(normal);
    if (length == 0) return normal;
    return Sum({0, 0, 0}, request_.sign[triangle] / length, normal);
  }

 private:
  const FillRequest& request_;
  const size_t triangles_;
};

// Whether the solid may be thinner than kLeastResolved behind a place on a side with this outward
// normal of length 1. The lattice point next to a place is at most 1.12 units off. So the first
// probe lies behind a thin part; the others find most thin parts with others behind.
inline bool MayBeThinBehind(const Coordinates& place, const Coordinates& normal,
                            NearbyBricks& bricks) {
  for (const double depth : {kLeastResolved + 1.2, kLeastResolved + 0.1, 1.2}) {
    if (!bricks.Contains(PointNear(Sum(place, -depth, normal), {1, 1, 1}))) return true;
  }
  return false;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_SURFACE_SIDES_H_
