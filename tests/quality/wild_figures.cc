#include "tests/quality/wild_figures.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/quality/wild_drawings.h"

namespace bccskel::quality {
namespace {

using shapes::Unit;
using Values = WildFigure::Values;

constexpr Vector kOrigin = {0, 0, 0};
constexpr double kThinnest = 1.5;  // radius of what any sampling still holds together

Piece Ball(Vector center, double radius) { return {center, center, radius, radius}; }

std::vector<Vector> SpreadDirections(Pen& pen, size_t count, double least_angle) {
  std::vector<Vector> directions;
  for (int tries = 0; directions.size() < count && tries < 20'000; ++tries) {
    const Vector way = pen.Direction();
    const auto near = [&](Vector other) { return Dot(way, other) > std::cos(least_angle); };
    if (std::ranges::none_of(directions, near)) directions.push_back(way);
  }
  return directions;
}

// A ball with thin spines: count, their lengths in radii of the body, their radii in steps.
Sketch Spines(Pen pen, const Values& v) {
  Sketch sketch{.pieces = {Ball(kOrigin, pen.size)}};
  for (const Vector& way : SpreadDirections(pen, static_cast<size_t>(v[0]), 0.35)) {
    const double out = pen.Between(v[1], v[2]) * pen.size, radius = pen.Between(v[3], v[4]);
    sketch.AddLimb({kOrigin, (pen.size + out - radius) * way, radius, radius}, out);
  }
  return sketch;
}

// A bottle brush: count of bristles, their lengths and radii in radii of the shaft.
Sketch Brush(Pen pen, const Values& v) {
  const double s = pen.size, half = 6 * s;
  const Piece shaft = {{-half, 0, 0}, {half, 0, 0}, s, s};
  Sketch sketch{.pieces = {shaft}};
  sketch.AddTipOf(shaft, 2 * s);
  sketch.AddTipOf(Reversed(shaft), 2 * s);
  for (int n = 0; n < v[0]; ++n) {
    const double x = (-0.85 + 1.7 * (n + pen.Between(0.3, 0.7)) / v[0]) * half;
    const Vector way = {0, std::cos(2.4 * n), std::sin(2.4 * n)};
    const double out = pen.Between(v[1], v[2]) * s;
    const double radius = std::max(pen.Between(v[3], v[4]) * s, kThinnest);
    const Vector from = {x, 0, 0};
    sketch.AddLimb({from, from + (s + out - radius) * way, radius, radius}, out);
  }
  return sketch;
}

// A flat palm, five fingers and a wrist cut flat: flatness of the palm, length of the fingers.
Sketch Palm(Pen pen, const Values& v) {
  const double s = pen.size;
  Sketch sketch{.pieces = {{{0, -0.5 * s, 0}, {0, 0.6 * s, 0}, 0.8 * s, s, v[0]}}};
  sketch.AddLimb(CutAtEnd({kOrigin, {0, -2.6 * s, 0}, 0.55 * s, 0.5 * s, 1.3}), 1.3 * s);
  for (int n = 0; n < 4; ++n) {
    const double x = -0.68 + 0.44 * n, angle = 0.35 * x + pen.Between(-0.03, 0.03);
    const double length = (v[1] + pen.Between(-0.1, 0.2)) * s, radius = pen.Between(0.16, 0.18) * s;
    const Vector from = {x * s, 0.9 * s, 0};
    const Vector way = {std::sin(angle), std::cos(angle), pen.Between(-0.1, 0.1)};
    sketch.AddLimb({from, from + (length + 0.4 * s) * way, radius, 0.9 * radius}, length);
  }
  const Vector thumb = Unit({1, pen.Between(0.3, 0.6), 0});
  sketch.AddLimb(
      {{0.4 * s, 0, 0}, {0.4 * s + 1.7 * s * thumb.x, 1.7 * s * thumb.y, 0}, 0.2 * s, 0.18 * s},
      1.2 * s);
  return sketch;
}

// A wide body with thumbs, thick where they leave it, that bend along its sides: flatness of the
// body, how many thumbs, the angle that they bend by, in which radius, in their own radii.
Sketch Thumbs(Pen pen, const Values& v) {
  const double s = pen.size, radius = 0.24 * s;
  const Piece body = {{0, -1.6 * s, 0}, {0, 1.6 * s, 0}, s, s, v[0]};
  Sketch sketch{.pieces = {body}};
  sketch.AddTipOf(body, s);
  sketch.AddTipOf(Reversed(body), s);
  for (int n = 0; n < v[1]; ++n) {
    const double side = n == 0 ? 1 : -1, height = pen.Between(-0.5, 0) * s;
    const double lift = pen.Between(-0.2, 0.2), bend = v[3] * radius;
    const auto at = [&](double x, double y) { return Vector{side * x, y, lift * x}; };
    const Vector root = at(0.5 * s, height), out = at(1.3 * s, height);
    sketch.pieces.push_back({root, out, 0.45 * s, radius});
    Vector last = out;
    constexpr int kParts = 8;
    for (int part = 1; part <= kParts; ++part) {
      const double angle = v[2] * part / kParts;
      const Vector next =
          at(1.3 * s + bend * std::sin(angle), height + bend * (1 - std::cos(angle)));
      sketch.pieces.push_back({last, next, radius, radius});
      last = next;
    }
    const Vector way = Unit(at(std::cos(v[2]), std::sin(v[2])));
    sketch.AddLimb({last, last + 0.4 * s * way, radius, 0.8 * radius}, 0.6 * s);
  }
  return sketch;
}

// A ball with flat limbs: their width by thickness, count, length in radii of the body.
Sketch FlatLimbs(Pen pen, const Values& v) {
  const double s = pen.size, width = 0.45 * s;
  Sketch sketch{.pieces = {Ball(kOrigin, s)}};
  for (const Vector& way : SpreadDirections(pen, static_cast<size_t>(v[1]), 1)) {
    Piece limb = {kOrigin, (s + v[2] * s - width) * way, width, width, v[0], pen.Across(way)};
    sketch.AddLimb(limb, v[2] * s);
    limb.from = 1.2 * s * way;
    sketch.line.push_back(limb);
  }
  return sketch;
}

// A flat limb alone, bent in its plane: width by thickness, length in half widths, angle.
Sketch FlatAlone(Pen pen, const Values& v) {
  Sketch sketch;
  const int parts = v[2] == 0 ? 1 : 24;
  const double s = pen.size, bend = v[2] == 0 ? 0.001 : v[2], radius = v[1] * s / bend;
  const auto at = [&](int n) { return InPlane(bend * n / parts, radius); };
  for (int n = 0; n < parts; ++n) sketch.line.push_back({at(n), at(n + 1), s, s, v[0]});
  sketch.pieces = sketch.line;
  sketch.AddTipOf(sketch.line.back(), v[1] * s / 2);
  sketch.AddTipOf(Reversed(sketch.line.front()), v[1] * s / 2);
  return sketch;
}

// A body that is higher than wide, with flat fins: thickness of the fins in radii, and whether the
// tail is forked.
Sketch Fish(Pen pen, const Values& v) {
  const double s = pen.size, thickness = std::max(v[0] * s, 2 * kThinnest);
  Sketch sketch;
  sketch.AddLimb({kOrigin, {1.8 * s, 0, 0}, s, 0.4 * s, 1.5, {0, 1, 0}}, 1.2 * s);
  sketch.pieces.push_back({kOrigin, {-3 * s, 0, 0}, s, 0.25 * s, 1.5, {0, 1, 0}});
  const auto fin = [&](Vector from, Vector to, double at_body, double at_end, Vector normal) {
    const double flat = std::min(at_body, at_end) * 2 * s / thickness;
    sketch.AddLimb({s * from, s * to, at_body * s, at_end * s, flat, Unit(normal)}, 0.8 * s);
  };
  const double lean = pen.Between(0.2, 0.5);
  fin({-0.2, 0, 0.6}, {-0.2 - lean, 0, 1.6}, 0.55, 0.3, {0, 1, 0});
  fin({-1.4, 0, -0.3}, {-1.4 - lean, 0, -1.2}, 0.4, 0.25, {0, 1, 0});
  for (const double side : {-1.0, 1.0}) {
    const Vector way = {-0.7, side * 1.1, -0.5};
    fin({0.9, side * 0.35, -0.2}, Vector{0.9, side * 0.35, -0.2} + way, 0.25, 0.4,
        Cross(way, {0.3, 0, 1}));
  }
  if (v[1] == 0) {
    fin({-3, 0, 0}, {-4, 0, 0}, 0.35, 0.8, {0, 1, 0});
  } else {
    for (const double side : {-1.0, 1.0}) {
      fin({-3, 0, 0}, {-4.3, 0, side * 1.2}, 0.35, 0.3, {0, 1, 0});
    }
  }
  return sketch;
}

// Cut flat at the thick end, sharp at the other, or at both: length, sharp radius, both.
Sketch Cone(Pen pen, const Values& v) {
  const double s = pen.size;
  const Piece cone = {kOrigin, {v[0] * s, 0, 0}, s, v[1] * s};
  Sketch sketch;
  sketch.AddLimb(cone, v[0] * s);
  Piece other = {kOrigin, {-v[0] * s, 0, 0}, s, v[1] * s};
  if (v[2] == 0) {
    other = Reversed(CutAtEnd(Reversed(cone)));
    sketch.pieces = {other};
    other = Reversed(other);
  } else {
    sketch.pieces.push_back(other);
  }
  sketch.AddTipOf(other, v[0] * s);
  return sketch;
}

// Flat and pointed, with a round base and a stalk: half the angle of the point, width by thickness,
// sharp radius.
Sketch Leaf(Pen pen, const Values& v) {
  const double s = pen.size, length = (1 - v[2]) * s / std::sin(v[0]);
  Sketch sketch;
  sketch.AddLimb({kOrigin, {length, 0, 0}, s, v[2] * s, v[1]}, length);
  const double stalk = s / v[1];
  sketch.AddLimb({kOrigin, {-3 * s, 0, 0}, stalk, 0.8 * stalk}, 2 * s);
  return sketch;
}

// Cylinders from one place, cut at their ends: count, length, width by thickness, how far behind
// the middle of the cap they are cut, in radii, 0: flat.
Sketch Cuts(Pen pen, const Values& v) {
  const double s = pen.size;
  Sketch sketch;
  for (int n = 0; n < v[0]; ++n) {
    const Vector way = InPlane(2 * kPi * n / v[0] + pen.Between(-0.2, 0.2) * (v[0] - 2), 1);
    sketch.AddLimb(CutAtEnd({kOrigin, v[1] * s * way, s, s, v[2]}, v[3] * s), (v[1] - 1) * s);
    Piece middle = {s * way, (v[1] - 1) * s * way, s, s};
    sketch.line.push_back(middle);
  }
  return sketch;
}

// A flat spiral of a tube: turns, space between them in radii, pieces it is broken into.
Sketch Spiral(Pen pen, const Values& v) {
  const double r = pen.size, pitch = (2 + v[1]) * r;
  const int parts = static_cast<int>(40 * v[0]);
  const auto at = [&](double n) {
    const double turn = n * v[0] / parts;
    return InPlane(2 * kPi * turn, 2.5 * r + pitch * turn);
  };
  Sketch sketch;
  double from = 0;
  for (int piece = 1; piece <= v[2]; ++piece) {
    const double to = piece == v[2] ? parts : parts * std::sqrt(piece / v[2]);
    const size_t first = sketch.line.size();
    for (double n = from; n + 1 <= to; ++n) sketch.line.push_back({at(n), at(n + 1), r, r});
    sketch.AddTipOf(sketch.line.back(), 4 * r);
    sketch.AddTipOf(Reversed(sketch.line[first]), 4 * r);
    const Vector end = sketch.line.back().to;
    while (Length(at(from) - end) < 4 * r || from < to) ++from;
  }
  sketch.pieces = sketch.line;
  return sketch;
}

// The hull of a large and a small ball: ratio of the radii, length.
Sketch Taper(Pen pen, const Values& v) {
  const Piece piece = {kOrigin, {v[1] * pen.size, 0, 0}, pen.size, pen.size / v[0]};
  Sketch sketch{.line = {piece}};
  sketch.AddLimb(piece, v[1] * pen.size);
  sketch.AddTipOf(Reversed(piece), pen.size);
  return sketch;
}

// Adds a tube along a curve of so many parts; its ends stick out by `out`.
void Sweep(Sketch& sketch, int parts, const std::function<Vector(int)>& at,
           const std::function<double(int)>& radius, double out) {
  for (int n = 0; n < parts; ++n) {
    sketch.line.push_back({at(n), at(n + 1), radius(n), radius(n + 1)});
  }
  sketch.pieces = sketch.line;
  sketch.AddTipOf(sketch.line.back(), out);
  sketch.AddTipOf(Reversed(sketch.line.front()), out);
}

// A bent body that narrows to a point at both ends: radius of its arc, the angle of that.
Sketch Crescent(Pen pen, const Values& v) {
  const double r = pen.size;
  constexpr int kParts = 40;
  const auto along = [](int n) { return 2.0 * n / kParts - 1; };
  const auto at = [&](int n) { return InPlane(along(n) * v[1] / 2, v[0] * r); };
  const auto radius = [&](int n) { return r * std::max(1 - along(n) * along(n), 0.06); };
  Sketch sketch;
  Sweep(sketch, kParts, at, radius, 2 * r);
  return sketch;
}

// Wide arms in a plane: count, flatness, radii at both ends, length.
Sketch Star(Pen pen, const Values& v) {
  const double s = pen.size;
  Sketch sketch;
  for (int n = 0; n < v[0]; ++n) {
    const Vector way = InPlane(2 * kPi * (n + pen.Between(-0.1, 0.1)) / v[0], 1);
    sketch.AddLimb({kOrigin, v[4] * s * way, v[2] * s, v[3] * s, v[1]}, (v[4] - v[2]) * s);
  }
  return sketch;
}

// One neurite that winds and swells, unbranched: length, swelling, roughness in radii.
Sketch Neurite(Pen pen, const Values& v) {
  const double r = pen.size;
  const double a = pen.Between(0, 6), b = pen.Between(0, 6), c = pen.Between(0, 6);
  constexpr int kParts = 80;
  const auto at = [&](int n) {
    const double t = 12.0 * n / kParts;
    return Vector{v[0] * r * n / kParts, 4 * r * std::sin(t + a), 3 * r * std::sin(0.7 * t + b)};
  };
  const auto radius = [&](int n) { return r * (1 + v[1] * std::sin(30.0 * n / kParts + c)); };
  Sketch sketch{.rough = v[2] * r, .wavelength = 1.5 * r};
  Sweep(sketch, kParts, at, radius, 6 * r);
  return sketch;
}

constexpr WildFigure kFigures[] = {
    {"spines", Spines, {20, 0.5, 1, 1.5, 3}},
    {"spines", Spines, {12, 0.5, 3, 2, 4}},
    {"spines", Spines, {30, 0.5, 1.5, 1.5, 2.5}, true},
    {"brush", Brush, {40, 1, 2, 0.12, 0.2}},
    {"brush", Brush, {60, 0.8, 1.5, 0.1, 0.15}, true},
    {"soma", Soma, {6, 2, 1.5, 3}},
    {"soma", Soma, {10, 3, 1.5, 2.5}, true},
    {"palm", Palm, {2.5, 1.4}},
    {"palm", Palm, {4, 1.1}, true},
    {"thumbs", Thumbs, {2.2, 1, 1.6, 1.5}},
    {"thumbs", Thumbs, {2.6, 2, 1.8, 2}},
    {"thumbs", Thumbs, {3, 2, 1.9, 1.2}, true},
    {"flat limbs", FlatLimbs, {2, 4, 2.5}},
    {"flat limbs", FlatLimbs, {4, 4, 2.5}},
    {"flat limbs", FlatLimbs, {6, 3, 2}, true},
    {"flat alone", FlatAlone, {2, 8, 0}},
    {"flat alone", FlatAlone, {4, 8, 0}},
    {"flat alone", FlatAlone, {6, 8, 0.8}},
    {"flat alone", FlatAlone, {4, 10, 1.2}, true},
    {"fish", Fish, {0.12, 0}},
    {"fish", Fish, {0.16, 1}, true},
    {"star", Star, {5, 3, 0.7, 0.3, 2.6}},
    {"star", Star, {6, 1.5, 0.9, 0.25, 3}, true},
    {"cone", Cone, {5, 0.02, 0}},
    {"cone", Cone, {4, 0.02, 1}},
    {"cone", Cone, {3, 0.1, 0}, true},
    {"taper", Taper, {8, 5}},
    {"taper", Taper, {8, 3}, true},
    {"crescent", Crescent, {3.1, 2.1}},
    {"crescent", Crescent, {2.1, 3.1}},
    {"crescent", Crescent, {4, 1.5}, true},
    {"crescent", Crescent, {2.4, 2.6}, true},
    {"leaf", Leaf, {0.4, 4, 0.1}},
    {"leaf", Leaf, {0.65, 4, 0.1}},
    {"leaf", Leaf, {0.55, 6, 0.15}, true},
    {"flat cut", Cuts, {2, 5, 1, 0}},
    {"flat cut", Cuts, {3, 4, 1, 0}},
    {"flat cut", Cuts, {2, 5, 2, 0}, true},
    {"blunt", Cuts, {2, 5, 1, 0.4}},
    {"blunt", Cuts, {3, 5, 1.3, 0.25}, true},
    {"plate", Plate, {0, 10}},
    {"disk", Plate, {1, 8}},
    {"disk", Plate, {2, 6}, true},
    {"casting", Casting, {4, 0.6}},
    {"casting", Casting, {6, 0.3}, true},
    {"network", Network, {30, 40, 5}},
    {"network", Network, {40, 50, 5}, true},
    {"spiral", Spiral, {3, 0.6, 3}},
    {"spiral", Spiral, {4, 0.4, 1}, true},
    {"neurite", Neurite, {60, 0.3, 0.15}},
    {"neurite", Neurite, {80, 0.4, 0.2}, true},
    {"round", Round, {}},
    {"bent plate", BentPlate, {kPi, 3, 0.06}},
    {"bent plate", BentPlate, {1.6, 1, 0.08}},
    {"bent plate", BentPlate, {kPi, 1.5, 0.2}},
    {"bent plate", BentPlate, {4.5, 4, 0.05}, true},
    {"bent plate", BentPlate, {2.4, 1.5, 0.1}, true},
    {"profile", Profile, {2, 4, 0.12}},
    {"profile", Profile, {4, 3, 0.1}},
    {"profile", Profile, {3, 4, 0.1}, true},
    {"profile", Profile, {5, 3, 0.12}, true},
    {"profile", Profile, {2, 1.5, 0.08}, true},
    {"open box", OpenBox, {1, 0.12, 1}},
    {"open box", OpenBox, {0.5, 0.06, 0.6}},
    {"open box", OpenBox, {1.6, 0.1, 0.7}, true},
    {"open box", OpenBox, {0.7, 0.2, 0.8}, true},
    {"flanged tube", FlangedTube, {3, 0.15, 0.5, 1}},
    {"flanged tube", FlangedTube, {4, 0.1, 0.4, 2}, true},
    {"perforated", PerforatedPlate, {3, 2, 0.5, 0.15}},
    {"perforated", PerforatedPlate, {4, 3, 0.6, 0.12}, true},
    {"ribbed", RibbedPlate, {2, 0.4, 0.08}},
    {"ribbed", RibbedPlate, {3, 0.7, 0.1}, true},
    {"teeth", Teeth, {10, 1.9, 1.4, 1}},
    {"teeth", Teeth, {8, 1.3, 1.5, 0}},
    {"teeth", Teeth, {12, 2.5, 1.6, 1}},
    {"teeth", Teeth, {9, 1.6, 1.5, 0}, true},
    {"teeth", Teeth, {8, 2.2, 1.5, 1}, true},
    {"strip", Strip, {1.5, 6}},
    {"strip", Strip, {2.5, 4}},
    {"strip", Strip, {1.8, 5}, true},
    {"axle", Axle, {2, 2.5, 0.25}},
    {"axle", Axle, {1, 3.5, 0.15}},
    {"axle", Axle, {3, 3, 0.2}, true},
    {"trunk", Trunk, {1.8, 0.4, 3}},
    {"trunk", Trunk, {2.2, 0.6, 2.5}},
    {"trunk", Trunk, {2, 0.5, 3}, true},
};

}  // namespace

std::span<const WildFigure> WildFigures() { return kFigures; }

}  // namespace bccskel::quality
