#include "core/pruning/flat_end.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/pruning/limb_anchor.h"

namespace bccskel {
namespace {

constexpr double kWidthSlope = 0.75;  // weight of the distance along the limb in a merit
constexpr double kAside = 0.4;        // weight of the sideways distance: corners lie sideways
constexpr double kFlatness = 1.5;     // W / radius: below this a limb is round
constexpr double kFlatMargin = 1.5;   // plus units: limbs as thick as surface steps are round
constexpr double kMostFlatness = 16;  // W is measured up to this many radii
constexpr double kMostMargin = 16;    // plus lattice units
constexpr double kRoundRadii = 4;     // distance from the end, in radii, where a flat limb is wide
constexpr double kMargin = 6;
constexpr double kCutWidths = 1.75;
constexpr double kAboutAsWide = 0.7;  // share of the largest W: the end itself is narrow
constexpr double kAsWide = 0.9;
constexpr double kAsWideMargin = 1;
constexpr double kLeastLimb = 0.3;  // least length of the limb before its end, in the largest W
constexpr double kLeastKept = 0.4;  // beginning of the limb, not walked again, in the largest W
constexpr double kAimWidths = 2;    // length, in W, that gives the limb's direction
constexpr double kLeastStride = 1;
constexpr double kStride = 8;          // places per W
constexpr size_t kNormalReach = 4;     // points on either side
constexpr double kWalkWidths = 1;      // the walk begins this many W before the end
constexpr double kWalkSlope = 0.85;    // walks enter no corners; leaves taper by up to this
constexpr double kWalkStep = 2;        // lattice units, times CoarsenessOf()
constexpr size_t kHeadingSteps = 12;   // the direction is that of the last twelve steps,
constexpr size_t kLeastHeading = 6;    // if there are at least six
constexpr double kMostWiden = 1.3;     // parts wider by this factor are not the limb
constexpr double kLeastInPlane = 0.3;  // least length of a direction within the sheet

// Whether the limb is flat where it is about as wide as anywhere.
bool IsFlat(std::span<const FlatEnd::Place> places, double widest) {
  size_t wide = 0, flat = 0;
  for (const FlatEnd::Place& place : places) {
    if (place.width < kAboutAsWide * widest) continue;
    ++wide;
    if (place.flat) ++flat;
  }
  return 2 * flat > wide;
}

// Needs: `way` has length 1.
double MeritOf(double width, const Coordinates& out, const Coordinates& way) {
  const double along = Dot(way, out);
  const double aside = std::sqrt(std::max(Dot(out, out) - along * along, 0.0));
  return width + kWidthSlope * along - kAside * aside;
}

}  // namespace

FlatEnd::FlatEnd(const Volume& object, const ExactRadius& radius, FirmDepth& depth)
    : scale_(AxisScaleOf(object.placement())),
      walk_step_(kWalkStep * CoarsenessOf(scale_)),
      radius_(radius),
      sheet_(object, radius),
      depth_(depth) {}

std::optional<FlatEnd::Tip> FlatEnd::In(std::span<const LatticePoint> path, const ThinSet& set) {
  const std::vector<Place> places = WidePlaces(path, set);
  if (places.empty()) return std::nullopt;
  const double widest = std::ranges::max(places, {}, &Place::width).width;
  if (!IsFlat(places, widest)) return std::nullopt;
  const size_t aim = std::ranges::find_if(places, [&](const Place& p) {
                       return p.width >= kAsWide * widest - kAsWideMargin;
                     })->position;
  if (set.Between(path[0], path[aim]) < kLeastLimb * widest) return std::nullopt;
  const auto before_aim = [&](double far, double least_limb) {
    size_t n = aim;
    while (n > 0 && set.Between(path[n], path[aim]) < far &&
           set.Between(path[0], path[n]) > least_limb) {
      --n;
    }
    return n;
  };
  const size_t before = before_aim(kAimWidths * widest, 0);
  const bool straight = set.Between(path[before], path[aim]) >= kAimWidths * widest;
  const Coordinates start = PlaceOf(path[before], scale_);
  const Coordinates way = Unit(Sum(PlaceOf(path[aim], scale_), -1, start));
  Tip tip{.from = before_aim(kWalkWidths * widest, kLeastKept * widest), .middle = {}};
  double most = -std::numeric_limits<double>::infinity();
  for (const Place& p : places) {
    const Coordinates out = Sum(PlaceOf(path[p.position], scale_), -1, start);
    const double merit = MeritOf(p.width, out, way);
    if (merit > most) tip.last = p.position, most = merit;
  }
  const Walker walker = {PlaceOf(path[tip.from], scale_), NormalAt(path, tip.from, set), way};
  const double longest = set.Between(path[tip.from], path.back()) + widest + kMargin;
  tip.middle = MiddleFrom(walker, widest, longest, straight);
  return tip;
}

// The places up to the best one.
std::vector<Coordinates> FlatEnd::MiddleFrom(Walker walker, double widest, double longest,
                                             bool straight) {
  const auto way = straight ? std::optional(walker.way) : std::nullopt;
  std::vector<Coordinates> places = {walker.place};
  std::vector<double> widths = {0};  // to the nearest rim
  for (double gone = 0; gone < longest && Step(walker); gone += walk_step_) {
    const auto [width, ahead] = MoveToMiddle(walker, widest);
    places.push_back(walker.place);
    widths.push_back(std::min(width, ahead));
    const size_t back = std::min(places.size() - 1, kHeadingSteps);
    if (ahead > width && back >= kLeastHeading) {
      const Coordinates heading = Sum(walker.place, -1, places[places.size() - 1 - back]);
      if (Dot(heading, heading) > 0) walker.way = Unit(heading);
    }
  }
  places.resize(BestOf(places, widths, way) + 1);
  return places;
}

// Position of the best place; the first counts only if it is alone. Beyond the end of the ridge, a
// corner of a limb that is cut at a slant lies beside the way of the limb.
size_t FlatEnd::BestOf(std::span<const Coordinates> places, std::span<const double> widths,
                       const std::optional<Coordinates>& way) const {
  const auto best_by = [&](double slope, auto aside) {
    size_t best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (size_t n = 1; n < places.size(); ++n) {
      const double gone = walk_step_ * static_cast<double>(n);
      const double merit = widths[n] + slope * gone - aside(places[n]);
      if (merit > most) most = merit, best = n;
    }
    return best;
  };
  const size_t ridge_end = best_by(kRidgeSlope, [](const Coordinates&) { return 0.0; });
  WayOn on;
  const double rest = walk_step_ * static_cast<double>(places.size() - 1 - ridge_end);
  if (way.has_value() && rest <= kCornerRadii * widths[ridge_end] + kMargin) {
    on = StraightOn(*way, widths[ridge_end]);
  }
  return best_by(kWalkSlope, [&](const Coordinates& place) {
    return on.Aside(Sum(place, -1, places[ridge_end]));
  });
}

// Returns whether there is a next place.
bool FlatEnd::Step(Walker& walker) {
  const auto in_plane = [&walker] {
    const Coordinates way = Sum(walker.way, -Dot(walker.way, walker.normal), walker.normal);
    const bool is_long = Dot(way, way) >= kLeastInPlane * kLeastInPlane;
    if (is_long) walker.way = Unit(way);
    return is_long;
  };
  if (!in_plane()) return false;
  const std::optional<Coordinates> next =
      sheet_.MiddleNear(Sum(walker.place, walk_step_, walker.way), walker.normal);
  if (!next.has_value()) return false;
  walker.place = *next;
  walker.normal = sheet_.NormalNear(walker.place, walker.normal);
  return in_plane();
}

// Moves at most half a step sideways, and not where the rim ahead is nearest: a walk that has left
// the middle for the rim returns.
FlatEnd::Sides FlatEnd::MoveToMiddle(Walker& walker, double widest) {
  const double longest = kMostWiden * widest + kFlatMargin;
  const Coordinates left = Cross(walker.normal, walker.way), right = Times(-1, left);
  const auto [place, normal, way] = walker;
  const double to_left = sheet_.WayToSide(place, way, left, normal, longest);
  const double to_right = sheet_.WayToSide(place, way, right, normal, longest);
  const double width = (to_left + to_right) / 2;
  const double ahead = sheet_.WayToRim(place, way, normal, width + walk_step_);
  if (ahead > std::min(to_left, to_right)) {
    const double aside = std::clamp((to_left - to_right) / 2, -walk_step_ / 2, walk_step_ / 2);
    walker.place = sheet_.MiddleNear(Sum(place, aside, left), normal).value_or(place);
  }
  return {width, ahead};
}

// From the end back as far as an end may be cut; none if the limb is round.
std::vector<FlatEnd::Place> FlatEnd::WidePlaces(std::span<const LatticePoint> path,
                                                const ThinSet& set) {
  std::vector<Place> places;
  ways_.assign(path.size(), std::nullopt);
  bool flat = false;  // so far
  for (size_t n = path.size(); n-- > 0;) {
    const double back = set.Between(path[n], path.back()), radius = depth_.At(path[n]);
    const double width = sheet_.WidthAt(PlaceOf(path[n], scale_), NormalAt(path, n, set),
                                        kMostFlatness * radius + kMostMargin);
    if (back > kCutWidths * width + kMargin) break;
    const bool is_flat = width > kFlatness * radius + kFlatMargin;
    flat = flat || is_flat;
    if (!flat && back > kRoundRadii * radius + kMargin) return {};
    places.push_back({n, width, is_flat});
    n -= std::min(n, static_cast<size_t>(std::max(width / kStride, kLeastStride)));
  }
  if (!flat) places.clear();
  return places;
}

// The mean over a few places, since noise may lie between a place and the background.
Coordinates FlatEnd::NormalAt(std::span<const LatticePoint> path, size_t position,
                              const ThinSet& set) {
  const size_t first = position - std::min(position, kNormalReach);
  const size_t last = std::min(position + kNormalReach, path.size() - 1);
  Coordinates sum = {0, 0, 0};
  for (size_t n = first; n <= last; ++n) {
    const Coordinates way = WayToBackground(path, n, set);
    sum = Sum(sum, Dot(sum, way) < 0 ? -1 : 1, way);
  }
  return Unit(sum);
}

// Returns a vector of length 1.
Coordinates FlatEnd::WayToBackground(std::span<const LatticePoint> path, size_t position,
                                     const ThinSet& set) {
  std::optional<Coordinates>& way = ways_[position];
  if (!way.has_value()) {
    const LatticePoint p = path[position];
    const LatticePoint background = radius_.FirstNearestAt(p, set.RadiusOf(p));
    way = Unit(WayBetween(p, background, scale_));
  }
  return *way;
}

}  // namespace bccskel
