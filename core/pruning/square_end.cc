#include "core/pruning/square_end.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/distance/places.h"

namespace bccskel {
namespace {

// In distances between the ends: how far the strip goes on behind the fork, and its half-width.
constexpr double kBehind = 0.9, kLeastHalf = 0.42, kMostHalf = 0.7;
constexpr double kFlatHalf = 1.5, kFlatUnits = 1.5;  // least half-width, in radii plus units
constexpr double kAsLong = 0.6;  // least length of the shorter branch, in lengths of the other
constexpr double kInset = 0.15;  // of the ways to the fork: the ends may lie on the rim

// Whether the straight line between the ends of two branches lies in the object.
bool IsInside(const ThinSet& set, LatticePoint end, LatticePoint other, LatticePoint fork,
              CrossSections& sections) {
  const Coordinates from = Sum(PlaceOf(end, set.scale()), kInset, set.Way(end, fork));
  const Coordinates way = set.Way(end, other);
  const double length = std::floor((1 - 2 * kInset) * LengthOf(way));
  return sections.WayOut(from, Unit(way), 0, length) >= length;
}

}  // namespace

bool LeadsIntoCornerOfStrip(const ThinSet& set, const FreeBranch& branch, CrossSections& sections) {
  const std::vector<LatticePoint> cluster = ClusterOf(set, *branch.junction);
  if (cluster.size() >= kMostClusterPoints) return false;
  const LatticePoint end = branch.points[0];
  for (const Arm& twin : ArmsOf(set, cluster)) {
    const LatticePoint other = twin.points.back(), fork = twin.fork;
    if (!twin.is_free || other == end || set.Between(end, other) > kLongestCompared) continue;
    const auto [shorter, longer] = std::minmax({set.Between(end, fork), set.Between(other, fork)});
    if (shorter < kAsLong * longer || !IsInside(set, end, other, fork, sections)) continue;
    const Coordinates behind = Sum(set.Way(end, fork), 1, set.Way(other, fork));
    if (Dot(behind, behind) == 0) continue;
    const double chord = set.Between(end, other), radius = set.RadiusOf(fork);
    CrossSection section = sections.Across(PlaceOf(fork, set.scale()), Unit(behind), radius, chord);
    sections.Refine(chord, section);
    const double half = section.half_width;
    if (half >= kFlatHalf * radius + kFlatUnits && half >= kLeastHalf * chord &&
        half <= kMostHalf * chord &&
        sections.OnwardInWall(section, kBehind * chord) >= kBehind * chord) {
      return true;
    }
  }
  return false;
}

}  // namespace bccskel
