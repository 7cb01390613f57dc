#ifndef BCCSKEL_CORE_IMPORT_MESH_RAY_CROSSING_H_
#define BCCSKEL_CORE_IMPORT_MESH_RAY_CROSSING_H_

#include <algorithm>
#include <array>
#include <cstdint>

namespace bccskel {

// Exact crossings of rays along +x with triangles on an integer grid.
//
// Why it is right: the ray through (y, z) is taken at (y + e, z + e^2) and its points at x + e^3
// for an e smaller than every rational that occurs (simulation of simplicity, Edelsbrunner and
// Muecke 1990, with the query point moved instead of the mesh). No such ray meets an edge or a
// vertex, so two triangles that share an edge agree about it, a ray through a closed surface
// crosses it an even number of times, and no column leaks. All arithmetic is on integers:
// coordinates of 40 bits, products of three within 123 bits.

// A point of the integer grid. Needs: 0 <= x, y, z < 2^40.
struct GridPoint {
  int64_t x = 0;
  int64_t y = 0;
  int64_t z = 0;

  friend constexpr bool operator==(const GridPoint&, const GridPoint&) = default;
};
inline constexpr int kGridBits = 40;

__extension__ using Int128 = __int128;

// Needs: divisor > 0.
constexpr Int128 CeilDivide(Int128 value, Int128 divisor) {
  const auto small_value = static_cast<int64_t>(value);
  const auto small_divisor = static_cast<int64_t>(divisor);
  if (small_value == value && small_divisor == divisor) {  // several times faster
    return small_value / small_divisor + (small_value % small_divisor > 0 ? 1 : 0);
  }
  const Int128 quotient = value / divisor;
  return quotient + (value % divisor > 0 ? 1 : 0);
}

// A half-open range of integers.
struct GridRange {
  int64_t begin = 0;
  int64_t end = 0;
  bool Contains(int64_t v) const { return v >= begin && v < end; }
};

class RayTriangle {
 public:
  RayTriangle(GridPoint a, GridPoint b, GridPoint c) : corner_{a, b, c} {
    SetNormal();
    if (nx_ >= 0) return;
    std::swap(corner_[1], corner_[2]);
    SetNormal();
    winding_ = 1;
  }

  // No ray crosses a triangle that is parallel to x.
  bool parallel() const { return nx_ == 0; }
  // What a ray along +x adds to its winding number here: +1 where it enters a solid with outward
  // normals, -1 where it leaves it.
  int winding() const { return winding_; }

  // The rays that may cross have z in this range.
  GridRange Rows() const {
    const auto [low, high] = std::minmax({corner_[0].z, corner_[1].z, corner_[2].z});
    return {low, high};
  }
  GridRange Columns() const {
    const auto [low, high] = std::minmax({corner_[0].y, corner_[1].y, corner_[2].y});
    return {low, high};
  }

  // The y of the rays in row z that cross.  Needs: !parallel().
  GridRange CrossedColumns(int64_t z) const {
    GridRange range = Columns();
    for (size_t n = 0; n < 3; ++n) Clip(corner_[n], corner_[(n + 1) % 3], z, range);
    return range;
  }

  // The first grid x behind the crossing on the ray (y, z).  Needs: the ray crosses.
  int64_t FirstBehind(int64_t y, int64_t z) const {
    const GridPoint& a = corner_[0];
    const Int128 reach = nx_ * a.x - ny_ * (y - a.y) - nz_ * (z - a.z);
    const Int128 first = CeilDivide(reach, nx_);
    const bool tie = first * nx_ == reach;
    const bool behind_on_tie = ny_ != 0 ? ny_ > 0 : nz_ >= 0;
    return static_cast<int64_t>(first) + (tie && !behind_on_tie ? 1 : 0);
  }

 private:
  // Twice the area vector.
  void SetNormal() {
    const auto& [a, b, c] = corner_;
    const Int128 bx = b.x - a.x, by = b.y - a.y, bz = b.z - a.z;
    const Int128 cx = c.x - a.x, cy = c.y - a.y, cz = c.z - a.z;
    nx_ = by * cz - bz * cy;
    ny_ = bz * cx - bx * cz;
    nz_ = bx * cy - by * cx;
  }

  // Keeps the y with (y + e, z + e^2) to the left of the edge from a to b.
  static void Clip(const GridPoint& a, const GridPoint& b, int64_t z, GridRange& range) {
    const Int128 dy = b.y - a.y, dz = b.z - a.z;
    if (dz == 0) {
      if ((dy > 0) != (z >= a.z)) range.end = range.begin;
      return;
    }
    const Int128 along = dy * (z - a.z);
    if (dz < 0) {  // y grows into the triangle
      range.begin = std::max(range.begin, a.y + static_cast<int64_t>(CeilDivide(-along, -dz)));
    } else {
      range.end = std::min(range.end, a.y + static_cast<int64_t>(CeilDivide(along, dz)));
    }
  }

  std::array<GridPoint, 3> corner_;
  Int128 nx_ = 0, ny_ = 0, nz_ = 0;
  int winding_ = -1;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_RAY_CROSSING_H_
