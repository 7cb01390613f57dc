#include "core/import/voxelize/shape_axes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/distance/places.h"

namespace bccskel {
namespace {

using Axes = std::array<WorldPoint, 3>;
using Matrix = std::array<std::array<double, 3>, 3>;

constexpr size_t kSamples = 4096;         // normals, evenly spaced by area
constexpr size_t kCandidateStride = 16;   // of these, every 16th may be the normal of a flat face
constexpr double kParallelSine = 0.0087;  // half a degree
constexpr double kFirstShare = 0.1;       // least share of the area with the first normal
constexpr double kSecondShare = 0.05;     // and with the second
constexpr double kClearlyLarger = 1.02;   // what a rounded area cannot change
constexpr double kDistinct = 1e-4;        // relative difference of moments, and least skewness
constexpr double kAlongWorld = 5e-9;      // cosine less than 1 of an angle of 1e-4

// Rotations as quaternions, of any length. Limbs, and planes of symmetry, run along the principal
// axes; there many lattice points are equally deep, and rounding would decide between them.
constexpr std::array<std::array<double, 4>, 3> kTurns = {
    {{1, 0.3, 0.2, 0.5}, {1, -0.4, 0.3, 0.2}, {1, 0.7, -0.5, 0.3}}};

WorldPoint Plus(const WorldPoint& a, const WorldPoint& b) { return Sum(a, 1, b); }

// A triangle, from the centroid of the surface.
struct Facet {
  std::array<WorldPoint, 3> corners;
  WorldPoint normal;
  double area;
};

class Facets {
 public:
  explicit Facets(const Surface& surface) {
    facets_.reserve(surface.triangles.size());
    for (const auto& [a, b, c] : surface.triangles) {
      const std::array corners = {surface.vertices[a], surface.vertices[b], surface.vertices[c]};
      const WorldPoint normal = Cross(Minus(corners[1], corners[0]), Minus(corners[2], corners[0]));
      const double twice = LengthOf(normal);
      if (!(twice > 0)) continue;
      facets_.push_back({corners, Times(1 / twice, normal), twice / 2});
      area_ += twice / 2;
    }
    Center();
  }

  bool empty() const { return facets_.empty() || !(area_ > 0); }

  // Normals of facets, evenly spaced by area.
  std::vector<WorldPoint> Normals() const {
    std::vector<WorldPoint> normals;
    const double step = area_ / static_cast<double>(kSamples);
    double passed = 0, next = step / 2;
    for (const Facet& facet : facets_) {
      for (passed += facet.area; passed > next; next += step) normals.push_back(facet.normal);
    }
    return normals;
  }

  // The mean of x x^T over the surface, x from its centroid.
  Matrix SecondMoments() const {
    Matrix sums = {};
    for (const Facet& facet : facets_) {
      const auto& [a, b, c] = facet.corners;
      const WorldPoint all = Plus(a, Plus(b, c));
      for (size_t i = 0; i < 3; ++i) {
        for (size_t j = 0; j < 3; ++j) {
          sums[i][j] += facet.area * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + all[i] * all[j]);
        }
      }
    }
    for (auto& row : sums) {
      for (double& sum : row) sum /= 12 * area_;
    }
    return sums;
  }

  // The means of squares and cubes of the position along an axis.
  std::pair<double, double> MomentsAlong(const WorldPoint& axis) const {
    double squares = 0, cubes = 0;
    for (const Facet& facet : facets_) {
      const double a = Dot(axis, facet.corners[0]), b = Dot(axis, facet.corners[1]),
                   c = Dot(axis, facet.corners[2]);
      squares += facet.area * (a * a + b * b + c * c + a * b + b * c + c * a) / 6;
      cubes += facet.area *
               (a * a * (a + b + c) + b * b * (a + b + c) + c * c * (a + b + c) + a * b * c) / 10;
    }
    return {squares / area_, cubes / area_};
  }

 private:
  // Moves the origin to the centroid of the surface.
  void Center() {
    WorldPoint sum = {0, 0, 0};
    for (const Facet& facet : facets_) {
      const auto& [a, b, c] = facet.corners;
      sum = Plus(sum, Times(facet.area, Plus(a, Plus(b, c))));
    }
    const WorldPoint centroid = Times(1 / (3 * area_), sum);
    for (Facet& facet : facets_) {
      for (WorldPoint& corner : facet.corners) corner = Minus(corner, centroid);
    }
  }

  std::vector<Facet> facets_;  // with an area
  double area_ = 0;
};

// The most frequent normal, up to its sign, among those perpendicular to `across` if that is given.
// None if it has less than `share` of all.
std::optional<WorldPoint> CommonNormal(const std::vector<WorldPoint>& normals, double share,
                                       const WorldPoint* across = nullptr) {
  const auto is_parallel = [](const WorldPoint& a, const WorldPoint& b) {
    const WorldPoint off = Cross(a, b);
    return Dot(off, off) < kParallelSine * kParallelSine;
  };
  const WorldPoint* common = nullptr;
  double most = share * static_cast<double>(normals.size()) / kClearlyLarger;
  for (size_t n = 0; n < normals.size(); n += kCandidateStride) {
    const WorldPoint& normal = normals[n];
    if (across != nullptr && std::abs(Dot(normal, *across)) > kParallelSine) continue;
    const auto count = static_cast<double>(std::ranges::count_if(
        normals, [&](const WorldPoint& other) { return is_parallel(normal, other); }));
    if (count > kClearlyLarger * most) common = &normal, most = count;
  }
  if (common == nullptr) return std::nullopt;
  WorldPoint sum = {0, 0, 0};
  for (const WorldPoint& normal : normals) {
    if (!is_parallel(*common, normal)) continue;
    sum = Plus(sum, Dot(normal, *common) < 0 ? Times(-1, normal) : normal);
  }
  return Unit(sum);
}

// Along flat faces.
std::optional<Axes> FaceAxes(const Facets& facets) {
  const std::vector<WorldPoint> normals = facets.Normals();
  const std::optional<WorldPoint> first = CommonNormal(normals, kFirstShare);
  if (!first.has_value()) return std::nullopt;
  const std::optional<WorldPoint> second = CommonNormal(normals, kSecondShare, &*first);
  if (!second.has_value()) return std::nullopt;
  const WorldPoint third = Unit(Cross(*first, *second));
  return Axes{*first, Cross(third, *first), third};
}

// Eigenvectors of a symmetric matrix, and its diagonal form in place of it, by Jacobi's method.
Axes Diagonalize(Matrix& m) {
  constexpr int kSweeps = 24;  // each squares what is off the diagonal
  Axes vectors = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const auto& [p, q] : {std::pair<size_t, size_t>{0, 1}, {0, 2}, {1, 2}}) {
      if (m[p][q] == 0) continue;
      const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
      const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      for (size_t k = 0; k < 3; ++k) {
        const double kp = m[k][p], kq = m[k][q];
        m[k][p] = c * kp - s * kq;
        m[k][q] = s * kp + c * kq;
      }
      for (size_t k = 0; k < 3; ++k) {
        const double pk = m[p][k], qk = m[q][k];
        m[p][k] = c * pk - s * qk;
        m[q][k] = s * pk + c * qk;
      }
      const WorldPoint old = vectors[p];
      vectors[p] = Plus(Times(c, old), Times(-s, vectors[q]));
      vectors[q] = Plus(Times(s, old), Times(c, vectors[q]));
    }
  }
  return vectors;
}

bool AreDistinct(double a, double b) {
  return std::abs(a - b) > kDistinct * std::max(std::abs(a), std::abs(b));
}

// Principal axes; where two are arbitrary, as of a solid of revolution, close to the world's. None
// if all are.
std::optional<Axes> PrincipalAxes(const Facets& facets) {
  Matrix moments = facets.SecondMoments();
  const Axes axes = Diagonalize(moments);
  const std::array<double, 3> along = {moments[0][0], moments[1][1], moments[2][2]};
  for (size_t n = 0; n < 3; ++n) {
    const size_t i = (n + 1) % 3, j = (n + 2) % 3;
    if (AreDistinct(along[i], along[j])) continue;
    if (!AreDistinct(along[n], along[i])) return std::nullopt;
    const WorldPoint only = Unit(axes[n]);
    WorldPoint world = {0, 0, 0};
    const auto least =
        std::ranges::min_element(only, {}, [](double v) { return std::abs(v); }) - only.begin();
    world[static_cast<size_t>(least)] = 1;
    const WorldPoint second = Unit(Minus(world, Times(Dot(world, only), only)));
    return Axes{only, second, Cross(only, second)};
  }
  const WorldPoint first = Unit(axes[0]);
  const WorldPoint third = Unit(Cross(first, axes[1]));
  return Axes{first, Cross(third, first), third};
}

bool AreTheWorlds(const Axes& axes) {
  return std::ranges::all_of(axes, [](const WorldPoint& axis) {
    return std::ranges::any_of(axis, [](double v) { return std::abs(v) > 1 - kAlongWorld; });
  });
}

// The order and the senses of the axes.
Axes Oriented(const Axes& axes, const Facets& facets) {
  std::array<double, 3> squares, skews;
  for (size_t n = 0; n < 3; ++n) {
    const auto [square, cube] = facets.MomentsAlong(axes[n]);
    squares[n] = square;
    skews[n] = square > 0 ? cube / (square * std::sqrt(square)) : 0;
  }
  // Two senses give the third.
  const auto least_skewed =
      std::ranges::min_element(skews, {}, [](double v) { return std::abs(v); }) - skews.begin();
  skews[static_cast<size_t>(least_skewed)] = 0;
  Axes best = axes;
  double closest = -std::numeric_limits<double>::infinity();
  std::array<size_t, 3> order = {0, 1, 2};
  do {
    const auto shorter_first = [&](size_t a, size_t b) {
      return squares[order[a]] < squares[order[b]] &&
             AreDistinct(squares[order[a]], squares[order[b]]);
    };
    if (shorter_first(0, 1) || shorter_first(1, 2) || shorter_first(0, 2)) continue;
    for (unsigned senses = 0; senses < 8; ++senses) {
      Axes turned;
      double closeness = 0;
      bool against_skew = false;
      for (size_t n = 0; n < 3; ++n) {
        const double sense = (senses >> n & 1) != 0 ? -1 : 1;
        turned[n] = Times(sense, axes[order[n]]);
        closeness += turned[n][n];
        against_skew = against_skew || sense * skews[order[n]] < -kDistinct;
      }
      const bool mirrored = Dot(Cross(turned[0], turned[1]), turned[2]) < 0;
      if (mirrored || against_skew || closeness <= closest) continue;
      closest = closeness;
      best = turned;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

Axes Turned(const Axes& axes, const std::array<double, 4>& turn) {
  const auto& [w, x, y, z] = turn;
  const Matrix rows = {{{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
                        {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
                        {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}}};
  Axes turned;
  for (size_t n = 0; n < 3; ++n) {
    turned[n] = Unit(Plus(Times(rows[n][0], axes[0]),
                          Plus(Times(rows[n][1], axes[1]), Times(rows[n][2], axes[2]))));
  }
  return turned;
}

}  // namespace

Surface ShapeAxes::Along(const Surface& surface) const {
  Surface own = surface;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  WorldPoint low = {kInfinity, kInfinity, kInfinity}, high = Times(-1, low);
  for (TriangleMesh::Vertex& v : own.vertices) {
    v = {Dot(axes[0], v), Dot(axes[1], v), Dot(axes[2], v)};
  }
  for (const TriangleMesh::Triangle& triangle : own.triangles) {
    for (uint32_t corner : triangle) {
      for (size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], own.vertices[corner][axis]);
        high[axis] = std::max(high[axis], own.vertices[corner][axis]);
      }
    }
  }
  const WorldPoint size = Minus(high, low);
  const double unit = std::ranges::max(size);
  for (TriangleMesh::Vertex& v : own.vertices) v = Times(1 / unit, Minus(v, low));
  own.lower = Times(2 * surface.half_size, low);
  own.upper_unit = Times(1 / unit, size);
  own.half_size = surface.half_size * unit;
  own.unit_volume = surface.unit_volume / (unit * unit * unit);
  return own;
}

Placement ShapeAxes::ToWorld(const Placement& own) const {
  Placement placement = own;
  for (size_t row = 0; row < 3; ++row) {
    placement.origin[row] = origin[row];
    for (size_t axis = 0; axis < 3; ++axis) {
      placement.direction[3 * row + axis] = axes[axis][row];
      placement.origin[row] += axes[axis][row] * own.origin[axis];
    }
  }
  return placement;
}

std::vector<ShapeAxes> ShapeAxesOf(const Surface& surface) {
  if (surface.report.closure == SurfaceClosure::kOpen) return {};
  const Facets facets(surface);
  if (facets.empty()) return {};
  std::optional<Axes> axes = FaceAxes(facets);
  const bool has_faces = axes.has_value();
  if (!has_faces) axes = PrincipalAxes(facets);
  if (!axes.has_value() || AreTheWorlds(*axes)) return {};
  axes = Oriented(*axes, facets);
  std::vector<ShapeAxes> choices;
  if (has_faces) choices.push_back({surface.lower, *axes});
  for (const auto& turn : kTurns) choices.push_back({surface.lower, Turned(*axes, turn)});
  return choices;
}

}  // namespace bccskel
