#ifndef BCCSKEL_CORE_PRUNING_CROSS_SECTION_H_
#define BCCSKEL_CORE_PRUNING_CROSS_SECTION_H_

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/distance/places.h"
#include "core/volume/volume.h"

namespace bccskel {

// Half a turn in eight steps: cosine and sine.
inline constexpr std::array<std::array<double, 2>, 8> kTurns = {{{1, 0},
                                                                 {0.92387953, 0.38268343},
                                                                 {0.70710678, 0.70710678},
                                                                 {0.38268343, 0.92387953},
                                                                 {0, 1},
                                                                 {-0.38268343, 0.92387953},
                                                                 {-0.70710678, 0.70710678},
                                                                 {-0.92387953, 0.38268343}}};

// The direction at a turn from u toward v. Needs: u and v have length 1 and are perpendicular.
inline Coordinates Turned(const std::array<double, 2>& turn, const Coordinates& u,
                          const Coordinates& v) {
  return Sum(Times(turn[0], u), turn[1], v);
}

// Rays all around in a plane.
inline constexpr size_t kRays = 2 * kTurns.size();
using RayWays = std::array<Coordinates, kRays>;  // of length 1
using RayLengths = std::array<double, kRays>;

// The direction of the n-th ray. Needs: the plane's vectors have length 1 and are perpendicular.
inline Coordinates RayIn(const std::array<Coordinates, 2>& plane, size_t n) {
  const auto& [cosine, sine] = kTurns[n % kTurns.size()];
  const double sign = n < kTurns.size() ? 1 : -1;
  return Turned({sign * cosine, sign * sine}, plane[0], plane[1]);
}

// The polygon between the ends of rays that start together.
struct RayPolygon {
  double area = 0;
  Coordinates middle = {0, 0, 0};  // the centroid, from their start
};
RayPolygon PolygonOf(const RayWays& ways, const RayLengths& lengths);

// A cross-section of the object at a point of a branch. All lengths are in lattice units.
struct CrossSection {
  Coordinates middle, way;  // `way`: direction of the branch, of length 1
  double radius = 0;
  Coordinates side = {0, 0, 0};  // direction of the widest line, of length 1
  double half_width = 0;         // the mean of the two sides of that line
  // Of a wall, the radius of the circle inscribed in it; else `radius`. 0: not known yet.
  double inscribed = 0;

  // By how much the object is wider than the radius.
  double WiderThanThick() const { return std::max(half_width - radius, 0.0); }
};

// Longer branches are not compared with what is around them. Where one axis is very long, lines of
// more steps of a unit would take too long.
inline constexpr double kLongestCompared = 2000;  // lattice units

// Measures how wide the object is across a branch, by lines that end where they leave it.
// Threads: one thread per instance.
class CrossSections {
 public:
  // Needs: `object` outlives this.
  explicit CrossSections(const Volume& object)
      : scale_(AxisScaleOf(object.placement())), bricks_(object) {}

  // The section with the widest of eight lines, each up to `reach` long to either side.
  // Needs: `way` has length 1; `radius` is that of the object at `middle`.
  CrossSection Across(const Coordinates& middle, const Coordinates& way, double radius,
                      double reach);
  // Refines the width of a section that is wider than round, by up to ten more lines beside the
  // widest. In walls, the widest line follows the wall. Returns whether the section became wider;
  // it never becomes narrower.
  bool Refine(double reach, CrossSection& section);
  // The narrower side of the line, of eight, of which that side is longest: a limb beside a trunk
  // is as wide as the limb on the other side. At most `reach`, which is at least `radius`.
  double NarrowerSide(const Coordinates& middle, const Coordinates& way, double radius,
                      double reach);
  // By how much the object is wider than the radius across a branch there, in lattice units.
  // `beside_limb`: to the narrower side only, since a limb lies to the other.
  // Needs: `way` has length 1; `reach` is at least `radius`.
  double WiderAcross(const Coordinates& middle, const Coordinates& way, double radius, double reach,
                     bool beside_limb);
  // How far the object extends, up to `reach`, in whole lattice units. Skips single missing points,
  // which are noise. Needs: it extends to `start`, a whole number.
  double WayOut(const Coordinates& from, const Coordinates& way, double start, double reach);
  // How far the background extends, up to `reach`, in whole lattice units.
  double WayToObject(const Coordinates& from, const Coordinates& way, double reach);
  // How far a wall extends from a refined section in the direction of the branch, up to `reach`;
  // the line follows the wall.
  double OnwardInWall(const CrossSection& section, double reach) {
    return WayInWall(FrontOf(section, section.way), section.radius, reach);
  }
  // The radius of the inscribed circle of a refined section, at most its half-width.
  double Inscribed(CrossSection& section);

 private:
  // The state of a line that follows a bent wall.
  struct Front {
    Coordinates middle;  // of the wall
    Coordinates way;     // of length 1
    Coordinates normal;  // of the wall, of length 1
    double length = 0;   // so far
  };

  void TurnFinely(double reach, CrossSection& section);
  // Whether lines there and back may be as long as this whole number of units: not if two points in
  // a row are missing there. Needs: as WayOut().
  std::array<bool, 2> MayReach(double length, const Coordinates& from, const Coordinates& way,
                               double start);
  bool Widen(const Coordinates& side, double reach, CrossSection& section);
  void FollowWall(double reach, CrossSection& section);
  double FindInscribed(const CrossSection& section);
  static Front FrontOf(const CrossSection& section, const Coordinates& way);
  double WayInWall(Front front, double radius, double reach);
  bool GoOnInWall(Front& front, double out, double radius);
  const AxisScale scale_;
  NearbyBricks bricks_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_CROSS_SECTION_H_
