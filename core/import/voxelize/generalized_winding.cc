#include "core/import/voxelize/generalized_winding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/import/voxelize/grid_fit.h"
#include "core/lattice/lattice_point.h"

namespace bccskel {
namespace {

using Vector = GeneralizedWindingRule::Vector;

constexpr double kInsideAbove = 0.5 + 1e-9;
constexpr double kFarInRadii = 4;
constexpr double kFourPi = 4 * std::numbers::pi;

Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector operator+(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vector operator*(const Vector& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double Length(const Vector& a) { return std::sqrt(Dot(a, a)); }
// Exact: 40 bits fit a double.
Vector InLatticeUnits(const GridPoint& p) {
  constexpr double kTick = 1.0 / (1 << kTickBits);
  return {static_cast<double>(p.x) * kTick, static_cast<double>(p.y) * kTick,
          static_cast<double>(p.z) * kTick};
}

std::array<Int128, 3> InTicks(const Vector& v) {
  constexpr double kTicks = 1 << kTickBits;
  return {static_cast<Int128>(v[0] * kTicks), static_cast<Int128>(v[1] * kTicks),
          static_cast<Int128>(v[2] * kTicks)};
}

// The sign of Dot(a, Cross(b, c)), exactly; 0 for a triangle without area. Where the origin lies in
// the triangle's plane it is moved as the rays are (see ray_crossing.h), so that solid angles and
// rays agree about the side.
double ExactSide(const Vector& a, const Vector& b, const Vector& c) {
  const auto [ax, ay, az] = InTicks(a);
  const auto [bx, by, bz] = InTicks(b - a);
  const auto [cx, cy, cz] = InTicks(c - a);
  const Int128 nx = by * cz - bz * cy, ny = bz * cx - bx * cz, nz = bx * cy - by * cx;
  const Int128 side = ax * nx + ay * ny + az * nz;
  if (side != 0) return side > 0 ? 1 : -1;
  const Int128 slope = ny != 0 ? ny : nz != 0 ? nz : nx;
  return slope == 0 ? 0 : slope < 0 ? 1 : -1;
}

// Solid angle of a triangle seen from the origin (Van Oosterom and Strackee 1983).
// Needs: corners whose coordinates are whole ticks.
double SolidAngle(const Vector& a, const Vector& b, const Vector& c) {
  constexpr double kRounding = 1e-14;  // of a determinant, relative to the lengths
  const double la = Length(a), lb = Length(b), lc = Length(c);
  const double along = la * lb * lc + Dot(a, b) * lc + Dot(b, c) * la + Dot(c, a) * lb;
  const double across = Dot(a, Cross(b, c));
  if (along > 0 || std::abs(across) > kRounding * la * lb * lc)
    return 2 * std::atan2(across, along);
  return 2 * ExactSide(a, b, c) * std::atan2(std::abs(across), along);
}

// Most that a boundary of this length adds to the gradient from this distance or farther.
double GradientBound(double length, double distance) {
  if (distance <= 0) return std::numeric_limits<double>::infinity();
  return length / (kFourPi * distance * distance);
}

void AppendSpan(CellSpan span, std::vector<CellSpan>& spans) {
  if (!spans.empty() && spans.back().end == span.begin) {
    spans.back().end = span.end;
  } else {
    spans.push_back(span);
  }
}

}  // namespace

GeneralizedWindingRule::GeneralizedWindingRule(std::span<const GridPoint> vertices,
                                               const BoundaryCaps& caps,
                                               const LatticeExtent& extent, int sign)
    : sign_(sign) {
  for (const auto& [begin, end] : caps.caps) {
    caps_.push_back(MakeCap(vertices, std::span(caps.triangles).subspan(begin, end - begin)));
    regions_.push_back(BoxOf(caps_.back(), extent));
  }
}

GeneralizedWindingRule::Cap GeneralizedWindingRule::MakeCap(
    std::span<const GridPoint> vertices, std::span<const TriangleMesh::Triangle> triangles) {
  Cap cap;
  cap.middle = InLatticeUnits(vertices[triangles[0][2]]);
  for (const auto& [a, b, c] : triangles) {
    const CapTriangle t = {InLatticeUnits(vertices[a]), InLatticeUnits(vertices[b]), cap.middle};
    cap.radius = std::max(cap.radius, Length(t.from - cap.middle));
    cap.perimeter += Length(t.to - t.from);
    cap.dipole = cap.dipole + Cross(t.from - t.apex, t.to - t.apex) * (0.5 / kFourPi);
    cap.triangles.push_back(t);
  }
  return cap;
}

SegmentRule::Region GeneralizedWindingRule::BoxOf(const Cap& cap, const LatticeExtent& extent) {
  const auto cells = [](double low, double high, int32_t limit) {
    return CellSpan{std::clamp(static_cast<int32_t>(std::floor((low - 1) / 2)), 0, limit),
                    std::clamp(static_cast<int32_t>(std::floor(high / 2)) + 1, 0, limit)};
  };
  Vector low = cap.middle, high = cap.middle;
  for (const CapTriangle& t : cap.triangles) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], t.from[axis]);
      high[axis] = std::max(high[axis], t.from[axis]);
    }
  }
  return {cells(low[0], high[0], extent.nx), cells(low[1], high[1], extent.ny),
          cells(low[2], high[2], extent.nz)};
}

void GeneralizedWindingRule::AddNear(const Cap& cap, const Vector& p, double reach, Field& field) {
  for (const CapTriangle& t : cap.triangles) {
    const Vector a = t.from - p, b = t.to - p;
    const double length = Length(t.to - t.from);
    field.value += SolidAngle(a, b, t.apex - p) / kFourPi;
    field.change += reach * GradientBound(length, Length((a + b) * 0.5) - length / 2 - reach);
  }
}

GeneralizedWindingRule::Field GeneralizedWindingRule::CapField(const Vector& p,
                                                               double reach) const {
  Field field;
  for (const Cap& cap : caps_) {
    const Vector to = cap.middle - p;
    const double distance = Length(to);
    if (distance <= kFarInRadii * cap.radius) {
      AddNear(cap, p, reach, field);
    } else {
      field.value += Dot(cap.dipole, to) / (distance * distance * distance);
      field.change += reach * GradientBound(cap.perimeter, distance - cap.radius - reach);
    }
  }
  return field;
}

void GeneralizedWindingRule::Append(const LatticeRow& row, CellSpan segment, int winding, int,
                                    std::vector<CellSpan>& inside) const {
  Decide(row, segment, winding, inside);
}

void GeneralizedWindingRule::Decide(const LatticeRow& row, CellSpan segment, int winding,
                                    std::vector<CellSpan>& inside) const {
  if (segment.begin >= segment.end) return;
  const int32_t middle = segment.begin + (segment.end - segment.begin) / 2;
  const LatticePoint p = PointAt(row.sublattice, middle, row.j, row.k);
  const double reach = segment.end - segment.begin;  // half of the segment in lattice units
  const Vector at = {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
  const Field field = CapField(at, segment.end - segment.begin == 1 ? 0 : reach);
  const double value = winding - sign_ * field.value;
  const bool is_inside = value > kInsideAbove;
  if (segment.end - segment.begin == 1 || std::abs(value - kInsideAbove) > field.change) {
    if (is_inside) AppendSpan(segment, inside);
    return;
  }
  Decide(row, {segment.begin, middle}, winding, inside);
  if (is_inside) AppendSpan({middle, middle + 1}, inside);
  Decide(row, {middle + 1, segment.end}, winding, inside);
}

}  // namespace bccskel
