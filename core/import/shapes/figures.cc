#include "core/import/shapes/figures.h"

#include <cmath>

#include "core/import/shapes/branching.h"
#include "core/import/shapes/random.h"

namespace bccskel::shapes {
namespace {

Spheroid BallAt(Vector center, double radius) { return {center, {0, 0, 1}, radius, radius}; }

// All balls contain the origin, so the union is star-shaped and therefore contractible.
std::vector<Solid> Blob(uint64_t seed) {
  Random random(seed);
  std::vector<Solid> balls;
  for (int n = 0; n < 24; ++n) {
    const Vector center = random.InUnitBall();
    balls.push_back(BallAt(center, Length(center) + random.Between(0.05, 0.4)));
  }
  return balls;
}

// Looks along +x and stands on -z.
std::vector<Solid> Horse() {
  std::vector<Solid> parts = {
      Spheroid{{0, 0, 0}, {1, 0, 0}, 1, 0.42},                       // belly
      Spheroid{{0.6, 0, 0.05}, {1, 0, 0}, 0.45, 0.42},               // chest
      Spheroid{{-0.65, 0, 0.05}, {1, 0, 0}, 0.45, 0.43},             // rump
      Spheroid{{1.1, 0, 0.62}, Unit({0.5, 0, 0.65}), 0.6, 0.2},      // neck
      Spheroid{{1.52, 0, 0.98}, Unit({0.8, 0, -0.45}), 0.38, 0.16},  // head
      Spheroid{{-1.2, 0, -0.2}, Unit({-0.4, 0, -1}), 0.55, 0.12},    // tail
  };
  for (double side : {-1.0, 1.0}) {
    parts.push_back(Spheroid{{1.33, side * 0.12, 1.2}, Unit({0, side * 0.3, 1}), 0.2, 0.09});
    for (double x : {-0.65, 0.6}) {
      parts.push_back(Spheroid{{x, side * 0.26, -0.75}, {0, 0, 1}, 0.65, 0.14});
    }
  }
  return parts;
}

struct Angle {
  double cos;
  double sin;
};
Angle Sum(Angle a, Angle b) {
  return {a.cos * b.cos - a.sin * b.sin, a.sin * b.cos + a.cos * b.sin};
}
Angle Half(Angle a) {  // Needs: an angle of the first quadrant.
  return {std::sqrt((1 + a.cos) / 2), std::sqrt((1 - a.cos) / 2)};
}

Vector TrefoilAt(Angle t) {
  const Angle twice = Sum(t, t), thrice = Sum(twice, t);
  return {t.sin + 2 * twice.sin, t.cos - 2 * twice.cos, -thrice.sin};
}

// A quarter turn halved five times: 128 pieces. Not from the library's sine, whose last bit differs
// between machines.
std::vector<Solid> Knot() {
  constexpr double kTubeRadius = 0.4;
  Angle step = {0, 1};
  for (int n = 0; n < 5; ++n) step = Half(step);
  std::vector<Solid> pieces;
  const Vector start = TrefoilAt({1, 0});
  Angle t = {1, 0};
  for (int n = 0; n < 128; ++n) {
    const Vector from = n == 0 ? start : TrefoilAt(t);
    t = Sum(t, step);
    pieces.push_back(RoundCone{from, n == 127 ? start : TrefoilAt(t), kTubeRadius, kTubeRadius});
  }
  return pieces;
}

}  // namespace

std::vector<Solid> FigureOf(Shape shape, uint64_t seed) {
  switch (shape) {
    case Shape::kBall:
      return {BallAt({}, 1)};
    case Shape::kTorus:
      return {Torus{.ring_radius = 2.6, .tube_radius = 1}};
    case Shape::kTubes:
      return GrowBranches(
          {.levels = 3, .trunk_length = 5.7, .length_ratio = 0.9, .radius_ratio = 0.85}, seed);
    case Shape::kBlob:
      return Blob(seed);
    case Shape::kHorse:
      return Horse();
    case Shape::kTree:
      return GrowBranches(
          {.levels = 5, .side_branches = 1, .trunk_length = 10, .taper = Taper::kToTheNextBranch},
          seed);
    case Shape::kKnot:
      return Knot();
    case Shape::kBox:
      return {Block{{3, 2, 1}}};
    case Shape::kHollowBall:
      return {BallShell{.outer_radius = 2, .inner_radius = 1}};
  }
  return {};
}

}  // namespace bccskel::shapes
