#ifndef BCCSKEL_TESTS_QUALITY_WILD_FIGURES_H_
#define BCCSKEL_TESTS_QUALITY_WILD_FIGURES_H_

#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "core/import/shapes/random.h"
#include "tests/quality/sketch.h"

// Random figures of the kinds that people have, beside the round ones of known_figure.h.

namespace bccskel::quality {

// What draws with: sizes are in sampling steps, lattice units or edges of voxels.
struct Pen {
  shapes::Random& random;
  double size;  // the radius of the body, or of whatever is the largest part

  double Between(double low, double high) { return random.Between(low, high); }
  Vector Direction() { return shapes::Unit(random.InUnitBall()); }
  Vector Across(Vector axis) { return shapes::Unit(Cross(axis, random.InUnitBall())); }
};

inline constexpr double kPi = std::numbers::pi;

// In the plane of x and y.
inline Vector InPlane(double angle, double radius) {
  return {radius * std::cos(angle), radius * std::sin(angle), 0};
}

struct WildFigure {
  const char* name;  // of the class
  using Values = std::array<double, 5>;
  Sketch (*draw)(Pen pen, const Values& values);
  Values values;            // see the function
  bool judge_only = false;  // rules are not chosen on it
};

std::span<const WildFigure> WildFigures();

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_WILD_FIGURES_H_
