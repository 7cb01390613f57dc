#include "core/import/mesh/ray_crossing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace bccskel {
namespace {

using Tetrahedron = std::array<GridPoint, 4>;

// Winding number of the tetrahedron's surface at a grid point, its faces turned outward.
int Winding(const Tetrahedron& t, const GridPoint& p) {
  constexpr int kFaces[4][4] = {{0, 2, 1, 3}, {0, 1, 3, 2}, {1, 2, 3, 0}, {2, 0, 3, 1}};
  const auto at = [&](int n) { return t[static_cast<size_t>(n)]; };
  const auto edge = [&](int n) {
    const GridPoint a = t[0], b = at(n);
    return std::array<Int128, 3>{b.x - a.x, b.y - a.y, b.z - a.z};
  };
  const auto b = edge(1), c = edge(2), d = edge(3);
  const Int128 turn = b[0] * (c[1] * d[2] - c[2] * d[1]) - b[1] * (c[0] * d[2] - c[2] * d[0]) +
                      b[2] * (c[0] * d[1] - c[1] * d[0]);
  int winding = 0;
  for (const auto& face : kFaces) {
    const RayTriangle triangle = turn > 0 ? RayTriangle(at(face[0]), at(face[1]), at(face[2]))
                                          : RayTriangle(at(face[0]), at(face[2]), at(face[1]));
    if (triangle.parallel() || !triangle.Rows().Contains(p.z)) continue;
    if (!triangle.CrossedColumns(p.z).Contains(p.y)) continue;
    if (p.x >= triangle.FirstBehind(p.y, p.z)) winding += triangle.winding();
  }
  return winding;
}

// The six tetrahedra around the diagonal of a box, by the orders of the axes.
std::vector<Tetrahedron> CutBox(const GridPoint& low, const GridPoint& high) {
  std::vector<Tetrahedron> cut;
  std::array<int, 3> order = {0, 1, 2};
  do {
    Tetrahedron t = {low, low, low, low};
    for (size_t n = 1; n < 4; ++n) {
      t[n] = t[n - 1];
      if (order[n - 1] == 0) t[n].x = high.x;
      if (order[n - 1] == 1) t[n].y = high.y;
      if (order[n - 1] == 2) t[n].z = high.z;
    }
    cut.push_back(t);
  } while (std::next_permutation(order.begin(), order.end()));
  return cut;
}

TEST(RayCrossingLaw, TetrahedraOfABoxShareEveryGridPointOfItWithoutOverlap) {
  const std::vector<Tetrahedron> cut = CutBox({1, 1, 1}, {6, 7, 5});
  for (int64_t z = 0; z < 9; ++z) {
    for (int64_t y = 0; y < 9; ++y) {
      for (int64_t x = 0; x < 9; ++x) {
        int total = 0;
        for (const Tetrahedron& t : cut) {
          const int winding = Winding(t, {x, y, z});
          EXPECT_TRUE(winding == 0 || winding == 1);
          total += winding;
        }
        const bool inside = x >= 1 && x < 6 && y >= 1 && y < 7 && z >= 1 && z < 5;
        EXPECT_EQ(total, inside ? 1 : 0) << x << " " << y << " " << z;
      }
    }
  }
}

TEST(RayCrossingLaw, ARandomPointCutsATetrahedronIntoFourThatFitExactly) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int64_t> coordinate(0, 8);
  const auto point = [&] {
    return GridPoint{coordinate(random), coordinate(random), coordinate(random)};
  };
  for (int round = 0; round < 300; ++round) {
    const Tetrahedron t = {point(), point(), point(), point()};
    const GridPoint inner = {(t[0].x + t[1].x + t[2].x + t[3].x) / 4,
                             (t[0].y + t[1].y + t[2].y + t[3].y) / 4,
                             (t[0].z + t[1].z + t[2].z + t[3].z) / 4};
    if (Winding(t, inner) == 0) continue;  // flat, or the middle was rounded out of it
    for (int64_t n = 0; n < 9 * 9 * 9; ++n) {
      const GridPoint p = {n % 9, n / 9 % 9, n / 81};
      int parts = 0;
      for (size_t corner = 0; corner < 4; ++corner) {
        Tetrahedron part = t;
        part[corner] = inner;
        parts += Winding(part, p);
      }
      ASSERT_EQ(parts, Winding(t, p))
          << "round " << round << " at " << p.x << " " << p.y << " " << p.z;
    }
  }
}

TEST(RayCrossing, DoesNotOverflowAtTheEndsOfTheGrid) {
  const int64_t far = (int64_t{1} << kGridBits) - 1;
  const Tetrahedron t = {GridPoint{0, 0, 0}, {far, 0, far}, {0, far, far}, {far, far, 0}};
  EXPECT_EQ(Winding(t, {far / 2, far / 2, far / 2}), 1);
  EXPECT_EQ(Winding(t, {far / 8, far / 8, far / 2}), 0);
  EXPECT_EQ(Winding(t, {far - 9, far - 9, far - 9}), 0);
  EXPECT_EQ(Winding(t, {far / 2, far / 2, far - 9}), 1);
}

}  // namespace
}  // namespace bccskel
