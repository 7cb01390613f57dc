#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/quality/wild_drawings.h"

namespace bccskel::quality {
namespace {

using Values = WildFigure::Values;

// Walls that meet overlap by this share of their thickness.
constexpr double kOverlap = 0.5;

// From the middle of one edge to that of the opposite one; `normal` of length 1.
Piece Wall(Vector from, Vector to, double half_width, double thickness, Vector normal) {
  return {from, to, half_width, half_width, 2 * half_width / thickness, normal, true};
}

// Walls along an arc around the z axis, from z = `low` to `high`.
void AddArc(Sketch& sketch, double radius, double angle, double low, double high,
            double thickness) {
  const int parts = static_cast<int>(std::ceil(angle * 16));
  const double half = std::max((radius + thickness) * angle / parts, thickness) / 2;
  for (int n = 0; n < parts; ++n) {
    // Those at the ends are no wider than the others let them be.
    const double margin = half / radius;
    const double turn = margin + (angle - 2 * margin) * n / (parts - 1);
    const Vector normal = {std::cos(turn), std::sin(turn), 0};
    const Vector at = radius * normal;
    sketch.pieces.push_back(Wall({at.x, at.y, low}, {at.x, at.y, high}, half, thickness, normal));
  }
}

}  // namespace

Sketch Plate(Pen pen, const Values& v) {
  const double s = pen.size;
  Sketch sketch{.knows_ends = false};
  Piece plate = {{-1.2 * s, 0, 0}, {1.2 * s, 0, 0}, s, s, v[1]};
  if (v[0] == 0) {
    plate.square = true;
  } else if (v[0] == 1) {
    plate = {{0, 0, -s / v[1]}, {0, 0, s / v[1]}, s, s};
    plate = Reversed(CutAtEnd(Reversed(CutAtEnd(plate))));
  } else {
    plate = {{0, 0, 0}, {0, 0, 0}, s, s, v[1]};
  }
  sketch.pieces.push_back(plate);
  return sketch;
}

Sketch Casting(Pen pen, const Values& v) {
  const double s = pen.size;
  Sketch sketch{.knows_ends = false};
  sketch.pieces.push_back({{-2 * s, 0, 0}, {2 * s, 0, 0}, s, s, 3, {0, 0, 1}, true});
  for (int n = 0; n < v[0]; ++n) {
    const double x = (-1.5 + 3.0 * n / (v[0] - 1)) * s, y = (n % 2 == 0 ? 0.4 : -0.4) * s;
    const double radius = pen.Between(0.25, 0.35) * s;
    sketch.pieces.push_back(CutAtEnd({{x, y, 0}, {x, y, (0.33 + v[1]) * s}, radius, 0.9 * radius}));
  }
  return sketch;
}

Sketch BentPlate(Pen pen, const Values& v) {
  Sketch sketch{.knows_ends = false};
  AddArc(sketch, pen.size, v[0], 0, v[1] * pen.size, v[2] * pen.size);
  return sketch;
}

Sketch Profile(Pen pen, const Values& v) {
  const double s = pen.size, length = v[1] * s, thickness = v[2] * s;
  Sketch sketch{.knows_ends = false};
  // A wall from (x, y) as wide as the others, along x or y.
  const auto add = [&](double x, double y, double way_x, double way_y) {
    const double more = kOverlap * thickness;
    const Vector middle = {x + (0.5 * s - more / 2) * way_x, y + (0.5 * s - more / 2) * way_y, 0};
    sketch.pieces.push_back(
        Wall(middle, {middle.x, middle.y, length}, (s + more) / 2, thickness, {way_y, way_x, 0}));
  };
  add(0, 0, 1, 0);
  if (v[0] == 2 || v[0] == 4) add(0, 0, 0, 1);
  if (v[0] == 4) add(s, 0, 0, 1);
  if (v[0] == 3 || v[0] == 5) add(0, 0, 0, 1), add(0, 0, 0, -1);
  if (v[0] == 5) add(s, 0, 0, 1), add(s, 0, 0, -1);
  return sketch;
}

Sketch OpenBox(Pen pen, const Values& v) {
  const double s = pen.size, height = v[0] * s, thickness = v[1] * s, width = v[2] * s;
  const double more = kOverlap * thickness;
  Sketch sketch{.knows_ends = false};
  sketch.pieces.push_back(
      Wall({-s - more, 0, 0}, {s + more, 0, 0}, width + more, thickness, {0, 0, 1}));
  for (const double side : {-1.0, 1.0}) {
    sketch.pieces.push_back(
        Wall({side * s, 0, -more}, {side * s, 0, height}, width + more, thickness, {1, 0, 0}));
    sketch.pieces.push_back(
        Wall({0, side * width, -more}, {0, side * width, height}, s + more, thickness, {0, 1, 0}));
  }
  return sketch;
}

Sketch FlangedTube(Pen pen, const Values& v) {
  const double s = pen.size, length = v[0] * s, thickness = v[1] * s, ring = v[2] * s;
  constexpr double kTurn = 2 * std::numbers::pi;
  Sketch sketch{.knows_ends = false};
  AddArc(sketch, s, kTurn, 0, length, thickness);
  for (int n = 0; n < v[3]; ++n) {
    AddArc(sketch, s + ring / 2, kTurn, n * (length - thickness),
           n * (length - thickness) + thickness, ring);
  }
  return sketch;
}

Sketch PerforatedPlate(Pen pen, const Values& v) {
  const double s = pen.size, thickness = v[3] * s, bridge = (1 - v[2]) * s;
  const double length = v[0] * s + bridge, width = v[1] * s + bridge;
  Sketch sketch{.knows_ends = false};
  for (int n = 0; n <= v[0]; ++n) {
    const double x = n * s + bridge / 2;
    sketch.pieces.push_back(Wall({x, 0, 0}, {x, width, 0}, bridge / 2, thickness, {0, 0, 1}));
  }
  for (int n = 0; n <= v[1]; ++n) {
    const double y = n * s + bridge / 2;
    sketch.pieces.push_back(Wall({0, y, 0}, {length, y, 0}, bridge / 2, thickness, {0, 0, 1}));
  }
  return sketch;
}

Sketch RibbedPlate(Pen pen, const Values& v) {
  const double s = pen.size, thickness = v[2] * s;
  Sketch sketch{.knows_ends = false};
  sketch.pieces.push_back(Wall({-1.5 * s, 0, 0}, {1.5 * s, 0, 0}, s, thickness, {0, 0, 1}));
  for (int n = 0; n < v[0]; ++n) {
    const double x = (-1 + 2 * (n + 0.5) / v[0]) * s;
    sketch.pieces.push_back(Wall({x, 0, 0}, {x, 0, v[1] * s}, s, thickness, {1, 0, 0}));
  }
  return sketch;
}

}  // namespace bccskel::quality
