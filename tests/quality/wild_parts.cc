#include <algorithm>

#include "tests/quality/wild_drawings.h"

namespace bccskel::quality {
namespace {

using Values = WildFigure::Values;

}  // namespace

Sketch Teeth(Pen pen, const Values& v) {
  const double s = pen.size, out = v[2] * s, pitch = std::max(4.5 * s / v[1], 3 * s);
  Sketch sketch;
  const auto tooth = [&](Vector root, Vector way, Vector normal) {
    sketch.AddLimb(CutAtEnd({root, root + (s + out) * way, s, s, v[1], normal}), out);
  };
  if (v[3] == 0) {
    const double half = (v[0] + 1) * pitch / 2;
    const Piece bar = {{-half, 0, 0}, {half, 0, 0}, s, s};
    sketch.pieces = {bar};
    sketch.AddTipOf(bar, 2 * s);
    sketch.AddTipOf(Reversed(bar), 2 * s);
    for (int n = 0; n < v[0]; ++n) {
      tooth({-half + (n + 1) * pitch, 0, 0}, {0, 1, 0}, {1, 0, 0});
    }
    return sketch;
  }
  const double ring = v[0] * pitch / (2 * kPi), turn = pen.Between(0, 1);
  constexpr int kParts = 48;
  for (int n = 0; n < kParts; ++n) {
    const double angle = 2 * kPi * n / kParts;
    sketch.pieces.push_back({InPlane(angle, ring), InPlane(angle + 2 * kPi / kParts, ring), s, s});
  }
  for (int n = 0; n < v[0]; ++n) {
    const double angle = 2 * kPi * (n + turn) / v[0];
    const Vector way = InPlane(angle, 1);
    tooth(ring * way, way, {-way.y, way.x, 0});
  }
  return sketch;
}

Sketch Strip(Pen pen, const Values& v) {
  const double half_width = pen.size, half_length = v[0] * half_width;
  Piece strip = {
      {-half_length, 0, 0}, {half_length, 0, 0}, half_width, half_width, v[1], {0, 0, 1}, true};
  Sketch sketch{.pieces = {strip}};
  strip.last_cut = strip.to;
  sketch.AddTipOf(strip, half_length);
  strip = Reversed(strip);
  strip.last_cut = strip.to;
  sketch.AddTipOf(strip, half_length);
  return sketch;
}

Sketch Axle(Pen pen, const Values& v) {
  const double s = pen.size / 2, radius = v[1] * s, thickness = v[2] * radius;
  const double half = (v[0] + 1) * 2.2 * s;
  const Piece shaft = {{-half, 0, 0}, {half, 0, 0}, s, s};
  Sketch sketch{.pieces = {shaft}};
  sketch.AddTipOf(shaft, 2 * s);
  sketch.AddTipOf(Reversed(shaft), 2 * s);
  for (int n = 0; n < v[0]; ++n) {
    const double at = half * (2 * (n + 1) / (v[0] + 1) - 1) + pen.Between(-0.2, 0.2) * s;
    const Piece wheel = {{at - thickness / 2, 0, 0}, {at + thickness / 2, 0, 0}, radius, radius};
    sketch.pieces.push_back(Reversed(CutAtEnd(Reversed(CutAtEnd(wheel)))));
  }
  return sketch;
}

Sketch Trunk(Pen pen, const Values& v) {
  const double s = pen.size / 2;
  const Piece trunk = {{-(v[0] + 6) * s, 0, 0}, {(v[0] - 1) * s, 0, 0}, s, s};
  Sketch sketch{.pieces = {trunk}};
  sketch.AddTipOf(trunk, v[0] * s);
  sketch.AddTipOf(Reversed(trunk), 4 * s);
  const Vector way = shapes::Unit({pen.Between(-0.5, 0.5), 1, pen.Between(-0.5, 0.5)});
  const double twig = v[1] * s;
  sketch.AddLimb({{0, 0, 0}, (s + v[2] * s - twig) * way, twig, twig}, v[2] * s);
  return sketch;
}

}  // namespace bccskel::quality
