#include "core/pruning/cross_section.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/distance/points_along.h"

namespace bccskel {
namespace {

constexpr double kRoundness = 1.5;  // half-width / radius; one of eight lines shows a plate
constexpr double kRoundMargin = 1;
constexpr double kWallFlatness = 2.5;  // half-width / radius: below this there is no wall
constexpr double kWallMargin = 3;      // plus units: limbs as thick as surface steps are no walls
constexpr double kMostThick = 3;   // half-thickness of a wall in radii: beyond, another wall begins
constexpr double kLeastOn = 0.25;  // a line continues in a wall by at least this many radii

constexpr double kFarthestLook = 1000;  // along a line: PointNear() needs places near the object

// Tangents of smaller turns to either side of the widest of these.
constexpr double kFirstTurn = 0.2, kLeastTurn = 0.01;

bool IsWall(const CrossSection& section) {
  return section.half_width >= kWallFlatness * section.radius + kWallMargin;
}

}  // namespace

RayPolygon PolygonOf(const RayWays& ways, const RayLengths& lengths) {
  constexpr double kSine = kTurns[1][1];  // of the angle between two rays
  RayPolygon polygon;
  Coordinates sum = {0, 0, 0};
  for (size_t n = 0; n < kRays; ++n) {
    const size_t next = (n + 1) % kRays;
    const double area = lengths[n] * lengths[next] * kSine / 2;
    sum = Sum(Sum(sum, area * lengths[n] / 3, ways[n]), area * lengths[next] / 3, ways[next]);
    polygon.area += area;
  }
  polygon.middle = Times(1 / polygon.area, sum);
  return polygon;
}

CrossSection CrossSections::Across(const Coordinates& middle, const Coordinates& way, double radius,
                                   double reach) {
  const auto [u, v] = ::bccskel::Across(way);
  CrossSection section = {middle, way, radius, u};
  for (const auto& turn : kTurns) Widen(Turned(turn, u, v), reach, section);
  return section;
}

double CrossSections::NarrowerSide(const Coordinates& middle, const Coordinates& way, double radius,
                                   double reach) {
  const auto [u, v] = ::bccskel::Across(way);
  const double start = FloorOf(radius);
  double longest = 0;
  for (const auto& turn : kTurns) {
    const Coordinates side = Turned(turn, u, v);
    const auto [may_there, may_back] = MayReach(longest + 1, middle, side, start);
    if (!may_there || !may_back) continue;
    const double there = WayOut(middle, side, start, reach);
    if (there <= longest) continue;
    longest = std::max(longest, WayOut(middle, Times(-1, side), start, there));
  }
  return longest;
}

double CrossSections::WiderAcross(const Coordinates& middle, const Coordinates& way, double radius,
                                  double reach, bool beside_limb) {
  if (beside_limb) return std::max(NarrowerSide(middle, way, radius, reach) - radius, 0.0);
  CrossSection section = Across(middle, way, radius, reach);
  Refine(reach, section);
  return section.WiderThanThick();
}

bool CrossSections::Refine(double reach, CrossSection& section) {
  const double before = section.half_width;
  const bool wide = before > kRoundness * section.radius + kRoundMargin;
  if (wide) TurnFinely(reach, section);
  if (wide && IsWall(section)) {
    FollowWall(reach, section);
  } else {
    section.inscribed = section.radius;
  }
  return section.half_width > before;
}

double CrossSections::Inscribed(CrossSection& section) {
  if (section.inscribed == 0) section.inscribed = FindInscribed(section);
  return section.inscribed;
}

// Lines that do not lie in a thin plate soon leave it.
void CrossSections::TurnFinely(double reach, CrossSection& section) {
  for (double turn = kFirstTurn; turn > kLeastTurn; turn /= 2) {
    const Coordinates from = section.side, across = Cross(section.way, from);
    if (Widen(Unit(Sum(from, turn, across)), reach, section)) continue;
    Widen(Unit(Sum(from, -turn, across)), reach, section);
  }
}

// Uses the mean of the line's two sides, since at a limb's end there is only one. Returns whether
// this line is the widest so far. Most are not, which shows where the longer side would have to
// reach: farther than the mean.
bool CrossSections::Widen(const Coordinates& side, double reach, CrossSection& section) {
  const double start = FloorOf(section.radius), longer = FloorOf(section.half_width) + 1;
  const auto [may_there, may_back] = MayReach(longer, section.middle, side, start);
  if (!may_there && !may_back) return false;
  const double there = WayOut(section.middle, side, start, reach);
  const double back = WayOut(section.middle, Times(-1, side), start, reach);
  const double half_width = (there + back) / 2;
  if (half_width <= section.half_width) return false;
  section.side = side;
  section.half_width = half_width;
  return true;
}

// Follows a bent wall, which a straight line soon leaves, to both sides of the widest line.
void CrossSections::FollowWall(double reach, CrossSection& section) {
  const double there = WayInWall(FrontOf(section, section.side), section.radius, reach);
  const Front other = FrontOf(section, Times(-1, section.side));
  const double back = WayInWall(other, section.radius, reach);
  section.half_width = std::max(section.half_width, (there + back) / 2);
}

// Uses the third shortest of 16 lines: noise, or a bend met at a slant, may end a line early.
double CrossSections::FindInscribed(const CrossSection& section) {
  std::array<double, 3> least;
  least.fill(section.half_width);
  for (const auto& turn : kTurns) {
    const Coordinates way = Turned(turn, section.side, section.way);
    for (const double side : {1.0, -1.0}) {
      const Front front = FrontOf(section, Times(side, way));
      least.back() = std::min(least.back(), WayInWall(front, section.radius, least.back()));
      std::ranges::sort(least);
    }
  }
  return std::max(least.back(), section.radius);
}

CrossSections::Front CrossSections::FrontOf(const CrossSection& section, const Coordinates& way) {
  return {section.middle, way, Cross(section.way, section.side)};
}

double CrossSections::WayInWall(Front front, double radius, double reach) {
  double out = WayOut(front.middle, front.way, std::floor(radius), reach);
  while (front.length + out < reach && GoOnInWall(front, out, radius)) {
    out = WayOut(front.middle, front.way, 0, reach - front.length);
  }
  return std::min(front.length + out, reach);
}

// Where the line leaves its wall, continues in a wall that meets it there, or else from the middle
// of its own wall. Returns false at a rim and where there is no wall.
bool CrossSections::GoOnInWall(Front& front, double out, double radius) {
  if (out < kLeastOn * radius + 1) return false;
  const double back = std::min(out, radius);
  const double most = kMostThick * radius + 1;
  const Coordinates below = Times(-1, front.normal);
  const auto ways = [&](const Coordinates& at) {
    return std::array{WayOut(at, front.normal, 0, most), WayOut(at, below, 0, most)};
  };
  const Coordinates corner = Sum(front.middle, out - back, front.way);
  const auto [wall_above, wall_below] = ways(corner);
  if (std::max(wall_above, wall_below) >= most) {
    const Coordinates way = wall_above > wall_below ? front.normal : below;
    front = {Sum(corner, radius, way), way, front.way, front.length + out - back + radius};
    return true;
  }
  const Coordinates at = Sum(front.middle, out, front.way);
  const auto [thick_above, thick_below] = ways(at);
  const Coordinates middle = Sum(at, (thick_above - thick_below) / 2, front.normal);
  const Coordinates step = Sum(middle, -1, front.middle), way = Unit(step);
  const Coordinates normal = Unit(Sum(front.normal, -Dot(front.normal, way), way));
  front = {middle, way, normal, front.length + LengthOf(step)};
  return true;
}

std::array<bool, 2> CrossSections::MayReach(double length, const Coordinates& from,
                                            const Coordinates& way, double start) {
  if (length <= start || length > kFarthestLook) return {true, true};
  const PointsOnLine<4> points = FindPointsToBothSides(from, way, length, scale_);
  return {bricks_.Contains(points[0]) || bricks_.Contains(points[1]),
          bricks_.Contains(points[2]) || bricks_.Contains(points[3])};
}

double CrossSections::WayOut(const Coordinates& from, const Coordinates& way, double start,
                             double reach) {
  double out = start;
  while (out < reach) {
    const PointsAlong ahead = FindPointsAlong(from, way, out + 1, 1, scale_);
    for (size_t n = 0; n + 2 <= PointsAlong::kCount && out < reach;) {
      if (bricks_.Contains(ahead[n])) {
        n += 1, out += 1;
      } else if (bricks_.Contains(ahead[n + 1])) {
        n += 2, out += 2;
      } else {
        return out;
      }
    }
  }
  return out;
}

double CrossSections::WayToObject(const Coordinates& from, const Coordinates& way, double reach) {
  double out = 0;
  while (out < reach) {
    const PointsAlong ahead = FindPointsAlong(from, way, out, 1, scale_);
    for (size_t n = 0; n < PointsAlong::kCount && out < reach; ++n, ++out) {
      if (bricks_.Contains(ahead[n])) return out;
    }
  }
  return reach;
}

}  // namespace bccskel
