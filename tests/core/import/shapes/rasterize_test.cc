#include "core/import/shapes/rasterize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace bccskel::shapes {
namespace {

// How deep a point lies in a solid, negative outside: exact in sign, written apart from the spans.
struct Depth {
  Vector p;

  double operator()(const Spheroid& s) const {
    const Vector q = p - s.center;
    const double along = Dot(q, s.axis);
    const double across = Dot(q, q) - along * along;
    return 1 - across / (s.across * s.across) - along * along / (s.along * s.along);
  }
  double operator()(const RoundCone& cone) const {
    double depth = -1e9;
    constexpr int kBalls = 4000;
    for (int n = 0; n <= kBalls; ++n) {
      const double t = static_cast<double>(n) / kBalls;
      const double radius = cone.from_radius + t * (cone.to_radius - cone.from_radius);
      depth = std::max(depth, radius - Length(cone.from + t * (cone.to - cone.from) - p));
    }
    return depth;
  }
  double operator()(const Torus& torus) const {
    const double off_ring = std::sqrt(p.x * p.x + p.y * p.y) - torus.ring_radius;
    return torus.tube_radius - std::sqrt(off_ring * off_ring + p.z * p.z);
  }
  double operator()(const BallShell& shell) const {
    return std::min(shell.outer_radius - Length(p), Length(p) - shell.inner_radius);
  }
  double operator()(const Block& block) const {
    return std::min({block.half_edges.x - std::abs(Dot(p, block.first)),
                     block.half_edges.y - std::abs(Dot(p, block.second)),
                     block.half_edges.z - std::abs(Dot(p, block.third()))});
  }
};

// All points deeper than rounding are there, all points further out than rounding are not.
void ExpectExactRaster(const Solid& solid, double scale) {
  const std::vector<Solid> solids = {solid};
  const auto volume = Rasterize(solids, scale);
  ASSERT_TRUE(volume.ok()) << volume.status();
  const Vector low = BoundsOf(solid).low;
  int inside = 0;
  for (Sublattice sublattice : kSublattices) {
    for (int32_t k = 0; k < volume->extent().nz; ++k) {
      for (int32_t j = 0; j < volume->extent().ny; ++j) {
        for (int32_t i = 0; i < volume->extent().nx; ++i) {
          const LatticePoint p = PointAt(sublattice, i, j, k);
          const Vector figure =
              low + (1 / scale) * Vector{p.x - 4.0, p.y - 4.0, p.z - 4.0};  // two free cells
          const double depth = std::visit(Depth{figure}, solid);
          if (std::abs(depth) < 1e-5) continue;
          ASSERT_EQ(volume->Contains(p), depth > 0) << p.x << " " << p.y << " " << p.z;
          inside += depth > 0;
        }
      }
    }
  }
  EXPECT_GT(inside, 100);
}

TEST(Rasterize, FillsSpheroids) {
  ExpectExactRaster(Spheroid{{5, -3, 2}, {0, 0, 1}, 1, 1}, 12);
  ExpectExactRaster(Spheroid{{0, 0, 0}, Unit({1, 2, -2}), 2, 0.7}, 7);
  ExpectExactRaster(Spheroid{{0, 0, 0}, Unit({3, 0, 1}), 0.5, 1.5}, 8);
}

TEST(Rasterize, FillsRoundConesOfAnyDirectionAndTaper) {
  ExpectExactRaster(RoundCone{{0, 0, 0}, {3, 0, 0}, 1, 0.5}, 5);
  ExpectExactRaster(RoundCone{{0, 0, 0}, {-3, 0.2, 0}, 1, 0.3}, 5);
  ExpectExactRaster(RoundCone{{0, 0, 0}, {0, 2, 0}, 0.4, 1}, 6);
  ExpectExactRaster(RoundCone{{0, 0, 0}, {1, 2, 3}, 0.8, 0.8}, 4);
  ExpectExactRaster(RoundCone{{0, 0, 0}, {0.2, 0, 0.1}, 1, 0.3}, 9);  // one ball holds the other
}

TEST(Rasterize, FillsSolidsWithHoles) {
  ExpectExactRaster(Torus{2.6, 1}, 5);
  ExpectExactRaster(BallShell{2, 1}, 6);
}

TEST(Rasterize, FillsBlocks) { ExpectExactRaster(Block{{3, 2, 1}}, 4.3); }

TEST(Rasterize, FillsTurnedBlocks) {
  const Vector first = Unit({1, 2, -2}), second = Unit(Cross(first, {0, 0, 1}));
  ExpectExactRaster(Block{{3, 2, 1}, first, second}, 4.3);
  ExpectExactRaster(Block{{3, 2, 1}, {0, 0.6, 0.8}, {1, 0, 0}}, 4.3);
}

TEST(Rasterize, FillsTheUnion) {
  const Solid a = Spheroid{{0, 0, 0}, {0, 0, 1}, 1, 1};
  const Solid b = Spheroid{{1, 0, 0}, {0, 0, 1}, 1, 1};
  const auto count = [](std::vector<Solid> solids) { return Rasterize(solids, 10)->PointCount(); };
  const uint64_t both = count({a, b});
  EXPECT_LT(both, count({a}) + count({b}));
  EXPECT_GT(both, count({a}));
  EXPECT_EQ(both, count({a, b, a}));
}

TEST(Rasterize, RefusesAFigureLargerThanTheLargestExtent) {
  const std::vector<Solid> ball = {Spheroid{}};
  EXPECT_EQ(Rasterize(ball, 5e6).status().code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace bccskel::shapes
