#include "core/pruning/collar.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/distance/places.h"
#include "core/pruning/tube_wall.h"

namespace bccskel {
namespace {

constexpr double kMostShaft = 0.7;   // largest radius of the shaft, in the branch's reach
constexpr double kLeastShaft = 1.2;  // the least, in half thicknesses of the collar
constexpr double kShaftGoesOn = 3;   // at least so many of its radii to one side of the collar
constexpr double kAllSides = 0.62;   // least extent to a side, in the reach: corners reach 0.7
constexpr double kClear = 1.15;      // and in radii of the shaft, plus a unit: outside of it
constexpr double kAsThin = 2;        // most extent there to either face, in the branch's radii
constexpr size_t kMostGaps = 3;      // sides of the 16 that may be shorter or thicker
// Least half-width across the branch, in radii plus units.
constexpr double kFlatCollar = 1.5, kFlatCollarUnits = 1;

}  // namespace

bool LeadsIntoCollar(const ThinSet& set, const FreeBranch& branch, CrossSections& sections) {
  const LatticePoint junction = *branch.junction, end = branch.points[0];
  const double shaft = set.RadiusOf(junction);
  const double reach = set.Between(junction, end) + set.RadiusOf(end);
  if (reach > kLongestCompared || shaft > kMostShaft * reach) return false;
  const auto outside = std::ranges::find_if(branch.points, [&](LatticePoint p) {
    return set.Between(p, junction) < (shaft + reach) / 2;
  });
  if (outside == branch.points.end()) return false;
  const double radius = set.RadiusOf(*outside);
  if (shaft < kLeastShaft * radius) return false;
  CrossSection section = sections.Across(PlaceOf(*outside, set.scale()),
                                         Unit(set.Way(junction, *outside)), radius, reach);
  sections.Refine(reach, section);
  if (section.half_width < kFlatCollar * radius + kFlatCollarUnits) return false;
  const Coordinates normal = Cross(section.way, section.side);
  const double off = Dot(normal, set.Way(junction, *outside));
  const Coordinates center = Sum(PlaceOf(junction, set.scale()), off, normal);
  const double far = std::floor(kShaftGoesOn * shaft);
  const bool goes_on = sections.WayOut(center, normal, 0, far) >= far ||
                       sections.WayOut(center, Times(-1, normal), 0, far) >= far;
  if (!goes_on) return false;
  const std::array<Coordinates, 2> plane = {section.way, section.side};
  const double least = std::floor(std::max(kAllSides * reach, kClear * shaft + 1));
  const double thick = std::floor(kAsThin * radius + 2);
  const auto is_collar = [&](const Coordinates& way) {
    if (sections.WayOut(center, way, 0, least) < least) return false;
    const Coordinates rim = Sum(center, least, way);
    return sections.WayOut(rim, normal, 0, thick) < thick &&
           sections.WayOut(rim, Times(-1, normal), 0, thick) < thick;
  };
  size_t gaps = 0;
  for (size_t n = 0; n < kRays && gaps <= kMostGaps; ++n) {
    if (!is_collar(RayIn(plane, n))) ++gaps;
  }
  return gaps <= kMostGaps;
}

bool IsArbitrary(const ThinSet& set, const FreeBranch& branch, CrossSections& sections) {
  return LeadsIntoCollar(set, branch, sections) || LiesInTubeWall(set, branch, sections);
}

}  // namespace bccskel
