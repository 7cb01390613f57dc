#include "core/pruning/flat_sheet.h"

#include <array>
#include <cmath>

namespace bccskel {
namespace {

constexpr double kStep = 1.5;               // along a line, in lattice units times CoarsenessOf()
constexpr double kMostOff = 2;              // farther off lies another sheet
constexpr double kThicknessStep = 0.5;      // lattice units
constexpr double kMostSheetThick = 24;      // largest thickness to either side
constexpr double kLeastNormalCosine = 0.7;  // between the normal and the nearest background
constexpr double kNormalWeight = 0.25;      // weight of a new normal

// Eighths of half a turn, from the first: cosine and sine.
constexpr std::array<std::array<double, 2>, 8> kSpreadTurns = {{{1, 0},
                                                                {0, 1},
                                                                {0.70710678, 0.70710678},
                                                                {-0.70710678, 0.70710678},
                                                                {0.92387953, 0.38268343},
                                                                {-0.38268343, 0.92387953},
                                                                {0.38268343, 0.92387953},
                                                                {-0.92387953, 0.38268343}}};

}  // namespace

FlatSheet::FlatSheet(const Volume& object, const ExactRadius& radius)
    : scale_(AxisScaleOf(object.placement())),
      step_(kStep * CoarsenessOf(scale_)),
      bricks_(object),
      radius_(radius) {}

double FlatSheet::WidthAt(const Coordinates& place, const Coordinates& normal, double longest) {
  double width = longest;
  const auto [u, v] = Across(normal);
  for (const auto& [cosine, sine] : kSpreadTurns) {
    const Coordinates way = Sum(Sum({0, 0, 0}, cosine, u), sine, v);
    for (const double side : {1.0, -1.0}) {
      width = WayToRim(place, Sum({0, 0, 0}, side, way), normal, width);
    }
  }
  return width;
}

double FlatSheet::WayToSide(const Coordinates& place, const Coordinates& way,
                            const Coordinates& side, const Coordinates& normal, double longest) {
  double shortest = longest;
  for (size_t turn = 1; turn < kSpreadTurns.size(); ++turn) {
    const auto& [cosine, sine] = kSpreadTurns[turn];
    const Coordinates out = Sum(Sum({0, 0, 0}, cosine, way), sine, side);
    shortest = WayToRim(place, out, normal, shortest);
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
  const Coordinates way = Unit(Sum(PlaceOf(background, scale_), -1, PlaceOf(p, scale_)));
  const double cosine = Dot(normal, way);
  if (std::abs(cosine) < kLeastNormalCosine) return normal;
  return Unit(Sum(normal, kNormalWeight * std::copysign(cosine * cosine, cosine), way));
}

}  // namespace bccskel
