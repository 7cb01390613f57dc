#include "tests/core/import/voxelize/winding_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bccskel::test {
namespace {

using Vector = std::array<double, 3>;

constexpr Vector kSkew = {0.5377390163, 0.2881726537, -0.7923154841};

// Distance to the segment from the origin to `along`.
double DistanceToSegment(const Vector& p, const Vector& along) {
  const double square = Dot(along, along);
  const double t = square > 0 ? std::clamp(Dot(p, along) / square, 0.0, 1.0) : 0;
  return LengthOf(Minus(p, Times(t, along)));
}

double DistanceToTriangle(const Vector& a, const Vector& b, const Vector& c, const Vector& p) {
  const Vector normal = Cross(Minus(b, a), Minus(c, a));
  double distance = std::numeric_limits<double>::infinity();
  bool above = LengthOf(normal) > 0;
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const Vector side = Minus(to, from), at = Minus(p, from);
    distance = std::min(distance, DistanceToSegment(at, side));
    above = above && Dot(Cross(side, at), normal) >= 0;
  }
  return above ? std::abs(Dot(Minus(p, a), normal)) / LengthOf(normal) : distance;
}

}  // namespace

SkewRay CastSkewRay(const TriangleMesh& mesh, const WorldPoint& p) {
  SkewRay ray;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vector a = Minus(mesh.vertices[i], p), b = Minus(mesh.vertices[j], p),
                 c = Minus(mesh.vertices[k], p);
    const double u = Dot(kSkew, Cross(a, b)), v = Dot(kSkew, Cross(b, c)),
                 w = Dot(kSkew, Cross(c, a));
    const bool left = u > 0 && v > 0 && w > 0, right = u < 0 && v < 0 && w < 0;
    if (!left && !right) continue;
    const bool ahead = Dot(a, Cross(b, c)) / (u + v + w) > 0;
    ray.winding += ahead ? (left ? 1 : -1) : 0;
    ray.crossings += ahead ? 1 : 0;
  }
  return ray;
}

double SolidAngleWinding(const TriangleMesh& mesh, const WorldPoint& p) {
  double angle = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vector a = Minus(mesh.vertices[i], p), b = Minus(mesh.vertices[j], p),
                 c = Minus(mesh.vertices[k], p);
    const double la = LengthOf(a), lb = LengthOf(b), lc = LengthOf(c);
    angle += 2 * std::atan2(Dot(a, Cross(b, c)),
                            la * lb * lc + Dot(a, b) * lc + Dot(b, c) * la + Dot(c, a) * lb);
  }
  return angle / (4 * std::numbers::pi);
}

double DistanceToSurface(const TriangleMesh& mesh, const WorldPoint& p) {
  double distance = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : mesh.triangles) {
    distance = std::min(
        distance, DistanceToTriangle(mesh.vertices[i], mesh.vertices[j], mesh.vertices[k], p));
  }
  return distance;
}

Agreement Compare(const Volume& volume, const TriangleMesh& mesh,
                  const std::function<bool(const WorldPoint&)>& is_inside) {
  Agreement result;
  const LatticeExtent& extent = volume.extent();
  const double rounding = std::ldexp(volume.placement().spacing[0] / 2, -15);
  for (Sublattice s : kSublattices) {
    for (int32_t k = 0; k < extent.nz; ++k) {
      for (int32_t j = 0; j < extent.ny; ++j) {
        for (int32_t i = 0; i < extent.nx; ++i) {
          const LatticePoint p = PointAt(s, i, j, k);
          const WorldPoint world = volume.placement().ToWorld(p);
          const bool inside = is_inside(world);
          ++result.points;
          result.inside += inside ? 1 : 0;
          if (inside == volume.Contains(p)) continue;
          result.different += DistanceToSurface(mesh, world) > rounding ? 1 : 0;
        }
      }
    }
  }
  return result;
}

}  // namespace bccskel::test
