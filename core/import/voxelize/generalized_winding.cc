#include "core/import/voxelize/generalized_winding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/import/mesh/boundary_loops.h"
#include "core/import/voxelize/grid_fit.h"
#include "core/lattice/lattice_point.h"

namespace bccskel {
namespace {

using Vector = GeneralizedWindingRule::Vector;

constexpr double kInsideAbove = 0.5 + 1e-9;
constexpr double kFarInRadii = 4;
constexpr double kFourPi = 4 * std::numbers::pi;

Vector operator-(const Vector& a, const Vector& b) { return Minus(a, b); }
Vector operator+(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vector operator*(const Vector& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
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
  const double la = LengthOf(a), lb = LengthOf(b), lc = LengthOf(c);
  const double along = la * lb * lc + Dot(a, b) * lc + Dot(b, c) * la + Dot(c, a) * lb;
  const double across = Dot(a, Cross(b, c));
  if (along > 0 || std::abs(across) > kRounding * la * lb * lc)
    return 2 * std::atan2(across, along);
  return 2 * ExactSide(a, b, c) * std::atan2(std::abs(across), along);
}

// Most that a part of the boundary adds to the gradient where all of it is this far away or
// farther.
double GradientBound(double length, double distance) {
  if (distance <= 0) return std::numeric_limits<double>::infinity();
  return length / (kFourPi * distance * distance);
}

// The same for a closed part, which is a dipole from so far away.
double DipoleBound(const Vector& dipole, double distance) {
  if (distance <= 0) return std::numeric_limits<double>::infinity();
  return 2 * LengthOf(dipole) / (distance * distance * distance);
}

// The same for a straight edge, which adds no more than an endless line.
double EdgeBound(const Vector& a, const Vector& b, double reach) {
  if (reach == 0) return 0;
  const Vector along = b - a;
  const double square = Dot(along, along);
  const double part = square == 0 ? 0 : std::clamp(-Dot(a, along) / square, 0.0, 1.0);
  const double distance = LengthOf(a + along * part) - reach;
  if (distance <= 0) return std::numeric_limits<double>::infinity();
  return std::min(GradientBound(std::sqrt(square), distance), 2 / (kFourPi * distance));
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
                                               std::span<const std::vector<uint32_t>> loops,
                                               const LatticeExtent& extent, int sign)
    : sign_(sign) {
  for (const std::vector<uint32_t>& loop : loops) {
    std::vector<Vector> points;
    points.reserve(loop.size());
    for (uint32_t vertex : loop) points.push_back(InLatticeUnits(vertices[vertex]));
    caps_.push_back(AddPatch(points));
    patches_.back().is_cap = true;
    regions_.push_back(BoxOf(points, extent));
  }
}

// As ForEachTriangleOfCap() splits it.
int32_t GeneralizedWindingRule::AddPatch(std::span<const Vector> loop) {
  if (loop.size() < 3) return kEdge;
  const size_t half = MiddleOfCap(loop.size());
  Patch patch = {{loop.front(), loop[half], loop.back()}};
  const auto& [a, b, c] = patch.corners;
  patch.beyond = {AddPatch(loop.first(half + 1)), AddPatch(loop.subspan(half))};
  const Vector doubled = Cross(b - a, c - a);
  patch.area = LengthOf(doubled) / 2;
  patch.dipole = doubled * (0.5 / kFourPi);
  patch.middle = (a + b + c) * (patch.area / 3);
  for (int32_t part : patch.beyond) {
    if (part == kEdge) continue;
    const Patch& beyond = patches_[static_cast<size_t>(part)];
    patch.area += beyond.area;
    patch.dipole = patch.dipole + beyond.dipole;
    patch.middle = patch.middle + beyond.middle * beyond.area;
  }
  patch.middle = patch.area > 0 ? patch.middle * (1 / patch.area) : b;
  for (size_t n = 0; n < loop.size(); ++n) {
    patch.radius = std::max(patch.radius, LengthOf(loop[n] - patch.middle));
    if (n > 0) patch.length += LengthOf(loop[n] - loop[n - 1]);
  }
  patches_.push_back(patch);
  return static_cast<int32_t>(patches_.size()) - 1;
}

SegmentRule::Region GeneralizedWindingRule::BoxOf(std::span<const Vector> loop,
                                                  const LatticeExtent& extent) {
  const auto cells = [](double low, double high, int32_t limit) {
    return CellSpan{std::clamp(static_cast<int32_t>(std::floor((low - 1) / 2)), 0, limit),
                    std::clamp(static_cast<int32_t>(std::floor(high / 2)) + 1, 0, limit)};
  };
  Vector low = loop[0], high = loop[0];
  for (const Vector& p : loop) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  return {cells(low[0], high[0], extent.nx), cells(low[1], high[1], extent.ny),
          cells(low[2], high[2], extent.nz)};
}

void GeneralizedWindingRule::AddField(int32_t patch, const Vector& p, double reach,
                                      Field& field) const {
  const Patch& at = patches_[static_cast<size_t>(patch)];
  const Vector to = at.middle - p;
  const double distance = LengthOf(to);
  if (distance > kFarInRadii * at.radius) {
    field.value += Dot(at.dipole, to) / (distance * distance * distance);
    const double nearest = distance - at.radius - reach;
    field.change +=
        reach * (at.is_cap ? DipoleBound(at.dipole, nearest) : GradientBound(at.length, nearest));
    return;
  }
  const Vector a = at.corners[0] - p, b = at.corners[1] - p, c = at.corners[2] - p;
  field.value += SolidAngle(a, b, c) / kFourPi;
  if (at.is_cap) field.change += reach * EdgeBound(c, a, reach);
  for (size_t side = 0; side < 2; ++side) {
    if (at.beyond[side] != kEdge) {
      AddField(at.beyond[side], p, reach, field);
    } else {
      field.change += reach * (side == 0 ? EdgeBound(a, b, reach) : EdgeBound(b, c, reach));
    }
  }
}

GeneralizedWindingRule::Field GeneralizedWindingRule::CapField(const Vector& p,
                                                               double reach) const {
  Field field;
  for (int32_t cap : caps_) AddField(cap, p, reach, field);
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
