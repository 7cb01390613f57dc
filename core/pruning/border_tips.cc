#include "core/pruning/border_tips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace bccskel {
namespace {

constexpr double kTouchMargin = 1;  // units between a ball and the border that it touches
constexpr double kFarRadii = 2;     // from an end to the border
// Length over which the way of a limb is measured, in its radius and units: wanted, and least.
constexpr double kBackRadii = 2, kBackMargin = 4, kLeastRadii = 0.75, kLeastMargin = 2;
constexpr double kLeastCosine = 0.3;              // between the limb and the normal of the border
constexpr double kMostWide = 4, kWideMargin = 2;  // from the middle to the surface, likewise
// How much the radius of a circle as large as the cut, seen along the limb, may differ from that of
// the section before: a share of it, and units.
constexpr double kMostChange = 0.25, kChangeMargin = 1;
constexpr double kPlaceStep = 2, kBeyond = 1;  // units
constexpr int kRounds = 3;
constexpr size_t kRays = 2 * kTurns.size();

Coordinates RayIn(const std::array<Coordinates, 2>& plane, size_t n) {
  const auto& [cosine, sine] = kTurns[n % kTurns.size()];
  const double sign = n < kTurns.size() ? 1 : -1;
  return Sum(Sum({0, 0, 0}, sign * cosine, plane[0]), sign * sine, plane[1]);
}

double RadiusOf(double area) { return std::sqrt(area / std::numbers::pi); }

}  // namespace

BorderTips::BorderTips(const Volume& object, const LatticeBox& image)
    : scale_(AxisScaleOf(object.placement())),
      low_(PlaceOf(image.low, scale_)),
      high_(PlaceOf(image.high, scale_)),
      sections_(object) {}

double BorderTips::OutFrom(const Coordinates& place, const Face& face) const {
  const size_t axis = face.axis;
  return face.side > 0 ? high_[axis] - place[axis] : place[axis] - low_[axis];
}

BorderTips::Face BorderTips::NearestFace(LatticePoint p) const {
  const Coordinates place = PlaceOf(p, scale_);
  Face nearest;
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const int32_t side : {-1, 1}) {
      if (OutFrom(place, {axis, side}) < OutFrom(place, nearest)) nearest = {axis, side};
    }
  }
  return nearest;
}

// Moves the middle to the centroid of what rays from it see, a few times. None if the object then
// extends to `reach`; before, where the middle may lie on one side, to twice as far.
std::optional<BorderTips::Section> BorderTips::SectionAt(Coordinates middle,
                                                         const std::array<Coordinates, 2>& plane,
                                                         double reach) {
  constexpr double kSine = kTurns[1][1];  // of the angle between two rays
  Section section;
  for (int round = 1; round <= kRounds; ++round) {
    const double most = round < kRounds ? 2 * reach : reach;
    section = {middle, 0};
    Coordinates sum = {0, 0, 0};
    std::array<double, kRays> lengths;
    std::array<Coordinates, kRays> ways;
    for (size_t n = 0; n < kRays; ++n) {
      ways[n] = RayIn(plane, n);
      lengths[n] = sections_.WayOut(middle, ways[n], 0, most) + 0.5;
      if (lengths[n] >= most) return std::nullopt;
    }
    for (size_t n = 0; n < kRays; ++n) {
      const size_t next = (n + 1) % kRays;
      const double area = lengths[n] * lengths[next] * kSine / 2;
      sum = Sum(Sum(sum, area * lengths[n] / 3, ways[n]), area * lengths[next] / 3, ways[next]);
      section.area += area;
    }
    section.middle = middle = Sum(middle, 1 / section.area, sum);
  }
  return section;
}

bool BorderTips::TouchesAcross(const Face& face, std::span<const LatticePoint> path, size_t n,
                               const ThinSet& set) {
  const double radius = set.RadiusOf(path[n]);
  const double reach = kMostWide * radius + kWideMargin;
  size_t back = n;
  while (back > 0 && set.Between(path[back], path[n]) < kBackRadii * radius + kBackMargin) --back;
  if (back == n) return false;
  const auto plane = Across(Unit(set.Way(path[back], path[n])));
  const Coordinates middle = PlaceOf(path[n], scale_);
  for (size_t ray = 0; ray < kRays; ++ray) {
    const Coordinates way = RayIn(plane, ray);
    const double length = sections_.WayOut(middle, way, 0, reach) + 1;
    if (OutFrom(Sum(middle, length, way), face) <= kTouchMargin) return true;
  }
  return false;
}

std::optional<BorderTips::Limb> BorderTips::LimbBefore(const Face& face,
                                                       std::span<const LatticePoint> path,
                                                       const ThinSet& set) {
  const auto out_at = [&](LatticePoint p) { return OutFrom(PlaceOf(p, scale_), face); };
  size_t from = path.size() - 1;
  if (out_at(path[from]) > kFarRadii * set.RadiusOf(path[from]) + kTouchMargin) return std::nullopt;
  while (from > 0 && out_at(path[from]) <= set.RadiusOf(path[from]) + kTouchMargin) --from;
  // Of a wide limb, the border may cut off a part of the section there.
  while (from > 0 && TouchesAcross(face, path, from, set)) --from;
  const double radius = set.RadiusOf(path[from]);
  const auto length_from = [&](size_t n) { return set.Between(path[n], path[from]); };
  size_t back = from;
  while (back > 0 && length_from(back) < kBackRadii * radius + kBackMargin) --back;
  if (length_from(back) < kLeastRadii * radius + kLeastMargin) return std::nullopt;
  Limb limb = {from, {}, Unit(set.Way(path[back], path[from])), kMostWide * radius + kWideMargin};
  const auto plane = Across(limb.way);
  const auto before = SectionAt(PlaceOf(path[back], scale_), plane, limb.reach);
  const auto last = SectionAt(PlaceOf(path[from], scale_), plane, limb.reach);
  if (!last.has_value()) return std::nullopt;
  limb.last = *last;
  if (before.has_value()) limb.way = Unit(Sum(last->middle, -1, before->middle));
  return limb;
}

std::optional<Coordinates> BorderTips::MiddleOfCut(const Face& face, const Limb& limb) {
  const double cosine = face.side * limb.way[face.axis];
  if (cosine < kLeastCosine) return std::nullopt;
  // A unit inside the face lie the middles of voxels.
  const double unit = scale_[face.axis], length = (OutFrom(limb.last.middle, face) - unit) / cosine;
  const double steps = std::max(std::floor(length), 0.0);
  if (sections_.WayOut(limb.last.middle, limb.way, 0, steps) < steps) return std::nullopt;
  std::array<Coordinates, 2> plane = {};
  plane[0][(face.axis + 1) % 3] = plane[1][(face.axis + 2) % 3] = 1;
  const Coordinates straight_on = Sum(limb.last.middle, length, limb.way);
  const auto cut = SectionAt(straight_on, plane, limb.reach / cosine);
  if (!cut.has_value()) return std::nullopt;
  const double wide = RadiusOf(limb.last.area), change = RadiusOf(cut->area * cosine) - wide;
  if (std::abs(change) > kMostChange * wide + kChangeMargin) return std::nullopt;
  return Sum(cut->middle, unit / cosine, limb.way);
}

std::optional<BorderTips::Way> BorderTips::WayOf(std::span<const LatticePoint> path,
                                                 const ThinSet& set) {
  const Face face = NearestFace(path.back());
  const std::optional<Limb> limb = LimbBefore(face, path, set);
  if (!limb.has_value()) return std::nullopt;
  const std::optional<Coordinates> middle = MiddleOfCut(face, *limb);
  if (!middle.has_value()) return std::nullopt;
  Way way = {limb->from, {}};
  // Growth stops a little before its last place, so that lies beyond the border.
  const Coordinates straight = Sum(Sum(*middle, kBeyond, limb->way), -1, limb->last.middle);
  const auto steps = static_cast<int>(std::ceil(std::sqrt(Dot(straight, straight)) / kPlaceStep));
  for (int n = 1; n <= steps; ++n) {
    way.places.push_back(Sum(limb->last.middle, 1.0 * n / steps, straight));
  }
  return way;
}

}  // namespace bccskel
