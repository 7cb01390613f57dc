#include "core/pruning/tube_wall.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/distance/places.h"
#include "core/pruning/tip_extender.h"

namespace bccskel {
namespace {

// Where the wall must surround the hollow, in the branch's points from its end.
constexpr std::array<double, 3> kPlaces = {0.125, 0.3, 0.5};
constexpr double kWidestTube = 60;  // longest line across the hollow, in radii of the branch
constexpr double kFarthest = 1000;  // longest line: PointNear() needs places near the object
constexpr double kOffCenter = 4;    // longest way from its middle to the wall, in half such lines
constexpr int kFinest = 4;          // how often the angle between two rays is halved
constexpr size_t kLeastPoints = 8;  // shorter branches have no direction
// Least half-width of a wall across the branch, in radii plus units.
constexpr double kWallWidth = 1.3, kWallWidthUnits = 1;

// A hollow across a branch, seen from a point in it.
class Hollow {
 public:
  Hollow(CrossSections& sections, const Coordinates& middle, const Coordinates& u,
         const Coordinates& v, double farthest)
      : sections_(sections), middle_(middle), plane_({u, v}), farthest_(farthest) {}

  // Whether the wall around it is closed: it is met in 16 directions, and from each to the next
  // leads a way in it.
  bool IsClosed() {
    std::array<Hit, kRays> hits;
    for (size_t n = 0; n < kRays; ++n) {
      hits[n] = In(RayIn(plane_, n));
      if (!hits[n].met) return false;
    }
    for (size_t n = 0; n < kRays; ++n) {
      if (!AreJoined(hits[n], hits[(n + 1) % kRays], kFinest)) return false;
    }
    return true;
  }

 private:
  struct Hit {
    bool met = false;
    Coordinates ray = {0, 0, 0};
    Coordinates place = {0, 0, 0};  // the middle of the wall
    double thick = 0;
  };

  Hit In(const Coordinates& ray) {
    const double way = sections_.WayToObject(middle_, ray, farthest_);
    if (way >= farthest_) return {};
    const double out = sections_.WayOut(Sum(middle_, way, ray), ray, 0, farthest_);
    return {true, ray, Sum(middle_, way + out / 2, ray), out};
  }

  bool AreJoined(const Hit& a, const Hit& b, int finer) {
    const Coordinates way = Sum(b.place, -1, a.place);
    const double length = std::floor(LengthOf(way));
    if (length == 0 || sections_.WayOut(a.place, Unit(way), 0, length) >= length) return true;
    if (finer == 0) return length <= std::max(a.thick, b.thick);  // steps of the surface
    const Hit between = In(Unit(Sum(a.ray, 1, b.ray)));
    return between.met && AreJoined(a, between, finer - 1) && AreJoined(between, b, finer - 1);
  }

  CrossSections& sections_;
  const Coordinates middle_;
  const std::array<Coordinates, 2> plane_;
  const double farthest_;
};

bool SurroundsHollow(const Coordinates& place, const Coordinates& way, double radius,
                     CrossSections& sections) {
  const double widest = std::min(kWidestTube * radius, kFarthest);
  const CrossSection section = sections.Across(place, way, radius, 4 * radius + 4);
  if (section.half_width < kWallWidth * radius + kWallWidthUnits) return false;
  const Coordinates normal = Cross(section.way, section.side);
  return std::ranges::any_of(std::array{1.0, -1.0}, [&](double side) {
    const Coordinates to = Times(side, normal);
    const double out = sections.WayOut(place, to, 0, widest) + 1;
    const Coordinates face = Sum(place, out, to);
    const double across = sections.WayToObject(face, to, widest);
    if (across >= widest) return false;
    Hollow hollow(sections, Sum(face, across / 2, to), normal, section.side,
                  std::min(kOffCenter * (across / 2 + 1), kFarthest));
    return hollow.IsClosed();
  });
}

}  // namespace

bool LiesInTubeWall(const ThinSet& set, const FreeBranch& branch, CrossSections& sections) {
  if (branch.points.size() < kLeastPoints) return false;
  return std::ranges::all_of(kPlaces, [&](double part) {
    const auto n = static_cast<size_t>(part * static_cast<double>(branch.points.size()));
    const LatticePoint p = branch.points[n];
    const Coordinates way = DirectionAt(branch.points, n, set.scale());
    return SurroundsHollow(PlaceOf(p, set.scale()), way, set.RadiusOf(p), sections);
  });
}

}  // namespace bccskel
