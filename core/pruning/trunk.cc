#include "core/pruning/trunk.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/pruning/junction_ball.h"

namespace bccskel {
namespace {

constexpr double kInJunction = 0.9;  // places nearer belong to the junction, in its radii
constexpr size_t kLeastPlaces = 3;   // fewer than these do not show a limb
// A trunk is measured at these distances from the junction, in its radii.
constexpr double kLeastTrunkRadii = 1.5, kMostTrunkRadii = 2.5, kTrunkStep = 0.5;
constexpr double kAsThick = 0.75;  // least radius of the trunk there, in that of the junction
// Half-width of a round trunk, in radii plus units.
constexpr double kRoundTrunk = 1.4, kRoundTrunkMargin = 1;

// Lines need not be longer to be those of something wide.
double ReachFor(double radius) { return 3 * radius + 3; }

}  // namespace

size_t FirstPlaceOutside(const ThinSet& set, const BranchPath& path, const Run& run) {
  size_t place = 0;
  const auto way = [&] { return set.Between(path.points[0], path.points[PlaceIn(run, place)]); };
  while (place < kRunPlaces && way() < kInJunction * path.radii[0]) ++place;
  return place;
}

std::optional<double> WidthBesideTrunk(const ThinSet& set, const BranchPath& path, const Run& run,
                                       CrossSections& sections) {
  const size_t first = FirstPlaceOutside(set, path, run);
  if (first + kLeastPlaces > kRunPlaces) return std::nullopt;
  std::vector<double> wider;
  for (size_t place = first; place < kRunPlaces; ++place) {
    const size_t n = PlaceIn(run, place);
    const double radius = path.radii[n];
    const double side =
        sections.NarrowerSide(PlaceOf(path.points[n], set.scale()),
                              DirectionAt(path.points, n, set.scale()), radius, ReachFor(radius));
    wider.push_back(std::max(side - radius, 0.0));
  }
  return MedianOf(std::move(wider));
}

bool LeavesTrunk(const ThinSet& set, const FreeBranch& branch, CrossSections& sections) {
  const JunctionBall ball(set, *branch.junction, branch.points, kMostTrunkRadii);
  const auto is_round = [&](std::span<const LatticePoint> way) {
    const double radius = set.RadiusOf(way.back());
    const Coordinates along = DirectionAt(way, way.size() - 1, set.scale());
    return sections.Across(PlaceOf(way.back(), set.scale()), along, radius, ReachFor(radius))
               .half_width <= kRoundTrunk * radius + kRoundTrunkMargin;
  };
  double thickest = 0;
  for (size_t exit : ball.exits()) {
    const std::vector<LatticePoint> way = ball.WayTo(exit);
    double next = kLeastTrunkRadii * ball.radius();
    bool any = false, round = false;
    for (size_t n = 1; n < way.size() && !round; ++n) {
      if (set.Between(way[0], way[n]) < next) continue;
      any = true;
      round = is_round(std::span(way).first(n + 1));  // another limb may leave there
      if (round) thickest = std::max<double>(thickest, set.RadiusOf(way[n]));
      next += kTrunkStep * ball.radius();
    }
    if (any && !round) return false;
  }
  return thickest >= kAsThick * ball.radius();
}

}  // namespace bccskel
