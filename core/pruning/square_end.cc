#include "core/pruning/square_end.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/distance/places.h"
#include "core/pruning/tip_extender.h"

namespace bccskel {
namespace {

// In distances between the ends: how far the strip goes on behind the fork, and its half-width.
constexpr double kBehind = 0.9, kLeastHalf = 0.42, kMostHalf = 0.7;
constexpr double kFlatHalf = 1.5, kFlatUnits = 1.5;  // least half-width, in radii plus units
constexpr double kAway = 0.5;    // of the place behind the fork where the width is compared
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

// Whether the object behind the fork, half the chord away on the curve of another arm, is about as
// wide as the chord is long. Between two legs that spread, the pelvis is, and the trunk is not.
bool IsAsWideBehind(const ThinSet& set, std::span<const Arm> arms, const Arm& twin,
                    LatticePoint end, double chord, CrossSections& sections) {
  return std::ranges::any_of(arms, [&](const Arm& arm) {
    if (&arm == &twin || arm.points.back() == end) return false;
    if (arm.points.size() < 2) return true;  // too short to tell
    const auto away = std::ranges::find_if(
        arm.points, [&](LatticePoint p) { return set.Between(twin.fork, p) >= kAway * chord; });
    const size_t last = arm.points.size() - 1;
    const size_t n = std::min(static_cast<size_t>(away - arm.points.begin()), last);
    const LatticePoint p = arm.points[n];
    CrossSection section = sections.Across(
        PlaceOf(p, set.scale()), DirectionAt(arm.points, n, set.scale()), set.RadiusOf(p), chord);
    sections.Refine(chord, section);
    return section.half_width >= kLeastHalf * chord;
  });
}

}  // namespace

bool LeadsIntoCornerOfStrip(const ThinSet& set, const FreeBranch& branch, CrossSections& sections) {
  const std::vector<LatticePoint> cluster = ClusterOf(set, *branch.junction);
  if (cluster.size() >= kMostClusterPoints) return false;
  const LatticePoint end = branch.points[0];
  const std::vector<Arm> arms = ArmsOf(set, cluster);
  for (const Arm& twin : arms) {
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
        sections.OnwardInWall(section, kBehind * chord) >= kBehind * chord &&
        IsAsWideBehind(set, arms, twin, end, chord, sections)) {
      return true;
    }
  }
  return false;
}

}  // namespace bccskel
