#include "core/import/shapes/solids.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bccskel::shapes {
namespace {

// Where a * t * t + 2 * b * t + c = 0, in increasing order; empty without a real solution.
// Needs: a != 0.
Span RootsOf(double a, double b, double c) {
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return {};
  const double root = std::sqrt(discriminant);
  const double first = (-b - root) / a, second = (-b + root) / a;
  return {std::min(first, second), std::max(first, second)};
}

// Symmetric around the origin; empty when the square of the half length is negative.
Span SymmetricSpan(double half_length_squared) {
  if (half_length_squared < 0) return {};
  const double half = std::sqrt(half_length_squared);
  return {-half, half};
}

// Takes the open span `hole` around the origin out of the span `whole` around the origin.
RowSpans WithoutHole(Span whole, Span hole) {
  if (whole.empty() || hole.empty()) return {whole, Span{}};
  return {Span{whole.low, hole.low}, Span{hole.high, whole.high}};
}

// A union of balls whose centers move along the axis with t from 0 to 1. On the row, the ball of t
// covers x(t) - sqrt(q(t)) .. x(t) + sqrt(q(t)) with q quadratic in t; the hull's end is an
// extremum of that, so it is at t = 0 or 1, where q = 0, or where the derivative is zero.
class RoundConeRow {
 public:
  RoundConeRow(const RoundCone& cone, double y, double z) : cone_(cone) {
    const Vector axis = cone.to - cone.from;
    const double dr = cone.to_radius - cone.from_radius;
    const double dy = y - cone.from.y, dz = z - cone.from.z;
    step_x_ = axis.x;
    a_ = dr * dr - axis.y * axis.y - axis.z * axis.z;
    b_ = cone.from_radius * dr + axis.y * dy + axis.z * dz;
    c_ = cone.from_radius * cone.from_radius - dy * dy - dz * dz;
  }

  Span Cover() {
    Include(0);
    Include(1);
    if (a_ != 0) {
      IncludeRoots(RootsOf(a_, b_, c_));
      IncludeTurningPoints();
    } else if (b_ != 0) {
      Include(-c_ / (2 * b_));
      Include((b_ * b_ / (step_x_ * step_x_) - c_) / (2 * b_));
    }
    return span_;
  }

 private:
  void IncludeRoots(Span roots) {
    if (roots.empty()) return;
    Include(roots.low);
    Include(roots.high);
  }

  // step_x * step_x * q(t) = (a * t + b)^2, solved so that rounding cannot lose the double root of
  // an axis normal to the row.
  void IncludeTurningPoints() {
    const double square = (a_ * c_ - b_ * b_) / (a_ - step_x_ * step_x_);
    if (!(square >= 0)) return;
    const double reach = step_x_ * std::sqrt(square);
    Include((-b_ - reach) / a_);
    Include((-b_ + reach) / a_);
  }

  void Include(double t) {
    if (!(t >= 0 && t <= 1)) return;
    const double q = (a_ * t + 2 * b_) * t + c_;
    if (q < 0) return;
    const double x = cone_.from.x + t * step_x_, half = std::sqrt(q);
    span_ = span_.empty() ? Span{x - half, x + half}
                          : Span{std::min(span_.low, x - half), std::max(span_.high, x + half)};
  }

  const RoundCone& cone_;
  double step_x_ = 0;
  double a_ = 0, b_ = 0, c_ = 0;  // q(t) = a * t * t + 2 * b * t + c
  Span span_;
};

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

struct SpansOnRow {
  double y;
  double z;

  RowSpans operator()(const Spheroid& s) const {
    const double dy = y - s.center.y, dz = z - s.center.z;
    const double flat = 1 / (s.across * s.across);
    const double stretch = 1 / (s.along * s.along) - flat;
    const double along = dy * s.axis.y + dz * s.axis.z;
    const Span span = RootsOf(flat + stretch * s.axis.x * s.axis.x, stretch * s.axis.x * along,
                              flat * (dy * dy + dz * dz) + stretch * along * along - 1);
    if (span.empty()) return {};
    return {Span{s.center.x + span.low, s.center.x + span.high}, Span{}};
  }
  RowSpans operator()(const RoundCone& cone) const {
    return {RoundConeRow(cone, y, z).Cover(), Span{}};
  }
  RowSpans operator()(const Torus& torus) const {
    const double half_squared = torus.tube_radius * torus.tube_radius - z * z;
    if (half_squared < 0) return {};
    const double half = std::sqrt(half_squared);
    const double outer = torus.ring_radius + half, inner = torus.ring_radius - half;
    return WithoutHole(SymmetricSpan(outer * outer - y * y), SymmetricSpan(inner * inner - y * y));
  }
  RowSpans operator()(const BallShell& shell) const {
    const double off_axis = y * y + z * z;
    return WithoutHole(SymmetricSpan(shell.outer_radius * shell.outer_radius - off_axis),
                       SymmetricSpan(shell.inner_radius * shell.inner_radius - off_axis));
  }
  RowSpans operator()(const Block& block) const {
    Span span = {-kUnbounded, kUnbounded};
    CutSlab(block.first, block.half_edges.x, span);
    CutSlab(block.second, block.half_edges.y, span);
    CutSlab(block.third(), block.half_edges.z, span);
    return {span, Span{}};
  }

 private:
  // Leaves the part of the span that is no farther than `half` from the plane through the origin.
  void CutSlab(Vector normal, double half, Span& span) const {
    const double height = y * normal.y + z * normal.z;
    if (normal.x == 0) {
      if (std::abs(height) > half) span = {};
      return;
    }
    const double a = (-half - height) / normal.x, b = (half - height) / normal.x;
    span = {std::max(span.low, std::min(a, b)), std::min(span.high, std::max(a, b))};
  }
};

Bounds Around(Vector center, Vector half) { return {center - half, center + half}; }
Bounds AroundBall(Vector center, double radius) { return Around(center, {radius, radius, radius}); }

struct BoundsOfSolid {
  Bounds operator()(const Spheroid& s) const {
    const double across = s.across * s.across, more = s.along * s.along - across;
    const auto half = [&](double axis) { return std::sqrt(across + more * axis * axis); };
    return Around(s.center, {half(s.axis.x), half(s.axis.y), half(s.axis.z)});
  }
  Bounds operator()(const RoundCone& cone) const {
    const Bounds a = AroundBall(cone.from, cone.from_radius);
    const Bounds b = AroundBall(cone.to, cone.to_radius);
    return {
        {std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
        {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
  }
  Bounds operator()(const Torus& torus) const {
    const double outer = torus.ring_radius + torus.tube_radius;
    return Around({}, {outer, outer, torus.tube_radius});
  }
  Bounds operator()(const BallShell& shell) const { return AroundBall({}, shell.outer_radius); }
  Bounds operator()(const Block& block) const {
    const Vector third = block.third();
    const auto half = [&](double a, double b, double c) {
      return block.half_edges.x * std::abs(a) + block.half_edges.y * std::abs(b) +
             block.half_edges.z * std::abs(c);
    };
    return Around({}, {half(block.first.x, block.second.x, third.x),
                       half(block.first.y, block.second.y, third.y),
                       half(block.first.z, block.second.z, third.z)});
  }
};

}  // namespace

double Length(Vector a) { return std::sqrt(Dot(a, a)); }
Vector Unit(Vector a) { return (1 / Length(a)) * a; }

RowSpans SpansAt(const Solid& solid, double y, double z) {
  return std::visit(SpansOnRow{y, z}, solid);
}

Bounds BoundsOf(const Solid& solid) { return std::visit(BoundsOfSolid{}, solid); }

}  // namespace bccskel::shapes
