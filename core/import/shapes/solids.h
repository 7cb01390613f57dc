#ifndef BCCSKEL_CORE_IMPORT_SHAPES_SOLIDS_H_
#define BCCSKEL_CORE_IMPORT_SHAPES_SOLIDS_H_

#include <array>
#include <variant>

namespace bccskel::shapes {

struct Vector {
  double x = 0;
  double y = 0;
  double z = 0;

  friend constexpr Vector operator+(Vector a, Vector b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr Vector operator-(Vector a, Vector b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend constexpr Vector operator*(double s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
};
constexpr double Dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vector Cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double Length(Vector a);
Vector Unit(Vector a);  // Needs: Length(a) > 0.

// Closed solids in figure units.
struct Spheroid {
  Vector center;
  Vector axis;        // of length 1
  double along = 1;   // half length along the axis
  double across = 1;  // radius at the center
};
// The convex hull of two balls: a branch that may taper.
struct RoundCone {
  Vector from;
  Vector to;
  double from_radius = 1;
  double to_radius = 1;
};
// Around the z axis.
struct Torus {
  double ring_radius = 2;
  double tube_radius = 1;
};
// The points of a ball around the origin that are not inside the inner one.
struct BallShell {
  double outer_radius = 2;
  double inner_radius = 1;
};
// Centered at the origin.
struct Block {
  Vector half_edges;
  // Where its edges point; of length 1 and normal to each other, the third edge to both.
  Vector first = {1, 0, 0};
  Vector second = {0, 1, 0};

  Vector third() const { return Cross(first, second); }
};
using Solid = std::variant<Spheroid, RoundCone, Torus, BallShell, Block>;

// The part of a line parallel to the x axis from `low` to `high`; empty when low > high.
struct Span {
  double low = 1;
  double high = 0;

  bool empty() const { return low > high; }
};
// A solid meets a line in at most two spans.
using RowSpans = std::array<Span, 2>;
RowSpans SpansAt(const Solid& solid, double y, double z);

struct Bounds {
  Vector low;
  Vector high;
};
Bounds BoundsOf(const Solid& solid);

}  // namespace bccskel::shapes

#endif  // BCCSKEL_CORE_IMPORT_SHAPES_SOLIDS_H_
