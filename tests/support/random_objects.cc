#include "tests/support/random_objects.h"

#include <random>

#include "core/lattice/directions.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/volume_where.h"

namespace bccskel::test {
namespace {

// The engine's numbers are fixed by the standard, those of the library's distributions are not.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  double Between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  bool Chance(double probability) { return Between(0, 1) < probability; }

 private:
  std::mt19937_64 engine_;
};

struct Ball {
  double x, y, z, radius;

  bool Contains(LatticePoint p) const {
    const double dx = p.x - x, dy = p.y - y, dz = p.z - z;
    return dx * dx + dy * dy + dz * dz <= radius * radius;
  }
};

template <typename Wanted>
std::vector<LatticePoint> PointsOfBox(LatticeExtent extent, Wanted wanted) {
  std::vector<LatticePoint> points;
  ForEachPointOf(extent, [&](int32_t x, int32_t y, int32_t z) {
    if (wanted(LatticePoint{x, y, z})) points.push_back({x, y, z});
  });
  return points;
}

}  // namespace

std::vector<LatticePoint> RandomCloud(uint64_t seed, LatticeExtent extent, double density) {
  Random random(seed);
  return PointsOfBox(extent, [&](LatticePoint) { return random.Chance(density); });
}

std::vector<LatticePoint> RandomBlob(uint64_t seed, LatticeExtent extent, int balls,
                                     double largest_radius) {
  Random random(seed);
  std::vector<Ball> all(static_cast<size_t>(balls));
  for (Ball& ball : all) {
    ball.x = random.Between(0, 2 * extent.nx);
    ball.y = random.Between(0, 2 * extent.ny);
    ball.z = random.Between(0, 2 * extent.nz);
    ball.radius = random.Between(2, largest_radius);
  }
  return PointsOfBox(extent, [&](LatticePoint p) {
    for (const Ball& ball : all) {
      if (ball.Contains(p)) return true;
    }
    return false;
  });
}

std::vector<LatticePoint> WithNoisyBoundary(uint64_t seed, std::span<const LatticePoint> points,
                                            double fraction) {
  Random random(seed);
  const ReferencePointSet object(points);
  std::vector<LatticePoint> noisy;
  object.ForEachLatticePointOfBox([&](LatticePoint p) {
    const bool inside = object.Contains(p);
    const bool on_border = object.NeighborsOf(p) != (inside ? kAllNeighbors : 0);
    const bool flip = on_border && p.x >= 0 && p.y >= 0 && p.z >= 0 && random.Chance(fraction);
    if (inside != flip) noisy.push_back(p);
  });
  return noisy;
}

std::vector<LatticePoint> RandomSubset(uint64_t seed, std::span<const LatticePoint> points,
                                       double density) {
  Random random(seed);
  std::vector<LatticePoint> subset;
  for (LatticePoint p : points) {
    if (random.Chance(density)) subset.push_back(p);
  }
  return subset;
}

std::vector<LatticePoint> Translated(std::span<const LatticePoint> points, LatticePoint by) {
  std::vector<LatticePoint> moved;
  moved.reserve(points.size());
  for (LatticePoint p : points) moved.push_back(p + by);
  return moved;
}

Volume PlacedVolume(uint64_t seed, std::span<const LatticePoint> points) {
  const auto step = [seed](uint64_t stride, uint64_t range) {
    return static_cast<int32_t>(seed * stride % range);
  };
  const int32_t odd = static_cast<int32_t>(seed % 2);
  const LatticePoint by = {2 * step(5, 17) + odd, 2 * step(3, 5) + odd, 2 * step(7, 9) + odd};
  return VolumeOfPoints(Translated(points, by));
}

}  // namespace bccskel::test
