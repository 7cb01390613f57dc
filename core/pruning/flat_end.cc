#include "core/pruning/flat_end.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bccskel {
namespace {

constexpr double kSlope = 0.75;       // of a tip's merit, along the limb
constexpr double kAside = 0.4;        // and across it: corners lie aside, points do not
constexpr double kFlatness = 1.5;     // width by radius: less is round
constexpr double kFlatMargin = 3;     // so are limbs as thick as the steps of the surface
constexpr double kMostFlatness = 16;  // and no width is looked for beyond this, and 16 units
constexpr double kMostMargin = 16;
constexpr double kRoundRadii = 4;  // so far from the end a flat limb is wide, in radii
constexpr double kMargin = 6;
constexpr double kCutWidths = 1.75;
constexpr double kAsWide = 0.9;  // of the largest width
constexpr double kHalfAsWide = 0.5;
constexpr double kLeastLimb = 0.5;  // of that: the limb before its end
constexpr double kAimWidths = 2;    // the limb's direction is that of so much of it
constexpr double kLeastStride = 1;
constexpr double kStride = 8;       // places in a width
constexpr double kStep = 1.5;       // lattice units
constexpr double kMostOff = 2;      // farther off lies another sheet
constexpr size_t kNormalReach = 4;  // points on either side

// Eighths of a half turn: cosine and sine.
constexpr std::array<std::array<double, 2>, 8> kTurns = {{{1, 0},
                                                          {0, 1},
                                                          {0.70710678, 0.70710678},
                                                          {-0.70710678, 0.70710678},
                                                          {0.92387953, 0.38268343},
                                                          {-0.38268343, 0.92387953},
                                                          {0.38268343, 0.92387953},
                                                          {-0.92387953, 0.38268343}}};

// Where the limb is about as wide as anywhere.
bool IsFlat(std::span<const FlatEnd::Place> places, double widest) {
  size_t wide = 0, flat = 0;
  for (const FlatEnd::Place& place : places) {
    if (place.width < kHalfAsWide * widest) continue;
    ++wide;
    if (place.flat) ++flat;
  }
  return 2 * flat > wide;
}

}  // namespace

FlatEnd::FlatEnd(const Volume& object, const ExactRadius& radius, FirmDepth& depth)
    : scale_(AxisScaleOf(object.placement())), bricks_(object), radius_(radius), depth_(depth) {}

std::optional<size_t> FlatEnd::In(std::span<const LatticePoint> path, const ThinSet& set) {
  const std::vector<Place> places = WidePlaces(path, set);
  if (places.empty()) return std::nullopt;
  const double widest = std::ranges::max(places, {}, &Place::width).width;
  if (!IsFlat(places, widest)) return std::nullopt;
  const Place aim =
      *std::ranges::find_if(places, [&](const Place& p) { return p.width >= kAsWide * widest; });
  if (set.Between(path[0], path[aim.position]) < kLeastLimb * widest) return std::nullopt;
  size_t from = aim.position;
  while (from > 0 && set.Between(path[from], path[aim.position]) < kAimWidths * widest) --from;
  const Coordinates start = PlaceOf(path[from], scale_);
  const Coordinates way = Unit(Sum(PlaceOf(path[aim.position], scale_), -1, start));
  Place best;
  double most = -std::numeric_limits<double>::infinity();
  for (const Place& p : places) {
    const Coordinates out = Sum(PlaceOf(path[p.position], scale_), -1, start);
    const double along = Dot(way, out);
    const double aside = std::sqrt(std::max(Dot(out, out) - along * along, 0.0));
    const double merit = p.width + kSlope * along - kAside * aside;
    if (merit > most) best = p, most = merit;
  }
  if (best.position + 1 >= path.size()) return std::nullopt;
  return best.position;
}

// From the end back, as far as an end may be cut; none where the limb is round.
std::vector<FlatEnd::Place> FlatEnd::WidePlaces(std::span<const LatticePoint> path,
                                                const ThinSet& set) {
  std::vector<Place> places;
  ways_.assign(path.size(), std::nullopt);
  bool flat = false;  // so far
  for (size_t n = path.size(); n-- > 0;) {
    const double back = set.Between(path[n], path.back()), radius = depth_.At(path[n]);
    const double width = WidthAt(PlaceOf(path[n], scale_), NormalAt(path, n, set),
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

// Noise may lie between a place and the background, so the normal is the mean of a few places'.
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

// Of length 1.
Coordinates FlatEnd::WayToBackground(std::span<const LatticePoint> path, size_t position,
                                     const ThinSet& set) {
  std::optional<Coordinates>& way = ways_[position];
  if (!way.has_value()) {
    const LatticePoint p = path[position], background = radius_.NearestAt(p, set.RadiusOf(p));
    way = Unit(Sum(PlaceOf(background, scale_), -1, PlaceOf(p, scale_)));
  }
  return *way;
}

double FlatEnd::WidthAt(const Coordinates& place, const Coordinates& normal, double longest) {
  double width = longest;
  const auto [u, v] = Across(normal);
  for (const auto& [cosine, sine] : kTurns) {
    const Coordinates way = Sum(Sum({0, 0, 0}, cosine, u), sine, v);
    for (const double side : {1.0, -1.0}) {
      width = WayToRim(place, Sum({0, 0, 0}, side, way), normal, width);
    }
  }
  return width;
}

// `longest` where the rim is farther.
double FlatEnd::WayToRim(Coordinates place, const Coordinates& way, const Coordinates& normal,
                         double longest) {
  for (double length = kStep; length < longest; length += kStep) {
    place = Sum(place, kStep, way);
    if (InObject(place)) continue;
    const std::optional<Coordinates> near = InSheetNear(place, normal);
    if (!near.has_value()) return length;
    place = *near;
  }
  return longest;
}

// The place moved along the normal until it is in the object again, and one unit deeper.
std::optional<Coordinates> FlatEnd::InSheetNear(const Coordinates& place,
                                                const Coordinates& normal) {
  for (double off = 1; off <= kMostOff; ++off) {
    for (const double side : {1.0, -1.0}) {
      if (!InObject(Sum(place, side * off, normal))) continue;
      const Coordinates deeper = Sum(place, side * (off + 1), normal);
      return InObject(deeper) ? deeper : Sum(place, side * off, normal);
    }
  }
  return std::nullopt;
}

}  // namespace bccskel
