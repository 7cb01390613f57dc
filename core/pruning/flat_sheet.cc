#include "core/pruning/flat_sheet.h"

#include <array>
#include <cmath>

#include "core/pruning/cross_section.h"

namespace bccskel {
namespace {

constexpr double kStep = 1.5;               // along a line, in lattice units times CoarsenessOf()
constexpr double kMostOff = 2;              // farther off lies another sheet
constexpr double kThicknessStep = 0.5;      // lattice units
constexpr double kMostSheetThick = 24;      // largest thickness to either side
constexpr double kLeastNormalCosine = 0.7;  // between the normal and the nearest background
constexpr double kNormalWeight = 0.25;      // weight of a new normal

// The order in which lines are measured, in kTurns: widely spread ones first, since a short line
// limits the others.
constexpr std::array<size_t, 8> kSpreadTurns = {0, 4, 2, 6, 1, 5, 3, 7};

}  // namespace

FlatSheet::FlatSheet(const Volume& object, const ExactRadius& radius)
    : scale_(AxisScaleOf(object.placement())),
      step_(kStep * CoarsenessOf(scale_)),
      bricks_(object),
      radius_(radius) {}

double FlatSheet::WidthAt(const Coordinates& place, const Coordinates& normal, double longest) {
  double width = longest;
  const auto [u, v] = Across(normal);
  for (const size_t turn : kSpreadTurns) {
    const Coordinates way = Turned(kTurns[turn], u, v);
    for (const double side : {1.0, -1.0}) {
      width = WayToRim(place, Times(side, way), normal, width);
    }
  }
  return width;
}

double FlatSheet::WayToSide(const Coordinates& place, const Coordinates& way,
                            const Coordinates& side, const Coordinates& normal, double longest) {
  double shortest = longest;
  for (const size_t turn : kSpreadTurns) {
    if (turn == 0) continue;
    shortest = WayToRim(place, Turned(kTurns[turn], way, side), normal, shortest);
  }
  return shortest;
}

double FlatSheet::WayToRim(Coordinates place, const Coordinates& way, const Coordinates& normal,
                           double longest) {
  for (double length = step_; length < longest; length += step_) {
    place = Sum(place, step_, way);
    if (InObject(place)) continue;
    const std::optional<Coordinates> near = InSheetNear(place, normal);
    if (near.has_value()) {
      place = *near;
      continue;
    }
    const Coordinates between = Sum(place, -step_ / 2, way);
    const bool in_sheet = InObject(between) || InSheetNear(between, normal).has_value();
    return length - (in_sheet ? 0.25 : 0.75) * step_;
  }
  return longest;
}

// The place, moved along the normal until it is in the object again and one unit deep.
std::optional<Coordinates> FlatSheet::InSheetNear(const Coordinates& place,
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

std::optional<Coordinates> FlatSheet::MiddleNear(const Coordinates& place,
                                                 const Coordinates& normal) {
  const std::optional<Coordinates> in = InObject(place) ? place : InSheetNear(place, normal);
  if (!in.has_value()) return std::nullopt;
  const auto thickness = [&](double side) {
    double out = 0;
    while (out < kMostSheetThick && InObject(Sum(*in, side * (out + kThicknessStep), normal))) {
      out += kThicknessStep;
    }
    return out;
  };
  return Sum(*in, (thickness(1) - thickness(-1)) / 2, normal);
}

Coordinates FlatSheet::NormalNear(const Coordinates& place, const Coordinates& normal) {
  const LatticePoint p = PointNear(place, scale_);
  if (!bricks_.Contains(p)) return normal;
  const LatticePoint background = radius_.FirstNearestAt(p, radius_.At(p));
  const Coordinates way = Unit(WayBetween(p, background, scale_));
  const double cosine = Dot(normal, way);
  if (std::abs(cosine) < kLeastNormalCosine) return normal;
  return Unit(Sum(normal, kNormalWeight * std::copysign(cosine * cosine, cosine), way));
}

}  // namespace bccskel
