#include "tests/support/reference_mask.h"

#include <algorithm>
#include <cstdlib>
#include <random>

namespace bccskel::test {
namespace {

ReferenceMask EmptyMask(int32_t nx, int32_t ny, int32_t nz) {
  return {nx, ny, nz,
          std::vector<uint8_t>(static_cast<size_t>(nx) * static_cast<size_t>(ny) *
                               static_cast<size_t>(nz))};
}

template <typename Visit>
void ForEachVoxel(LatticePoint low, LatticePoint high, Visit visit) {
  for (int32_t z = low.z; z <= high.z; ++z) {
    for (int32_t y = low.y; y <= high.y; ++y) {
      for (int32_t x = low.x; x <= high.x; ++x) visit(LatticePoint{x, y, z});
    }
  }
}

// 2^-32 of the engine's range, so that no library's distribution matters.
bool Chance(std::mt19937_64& random, double probability) {
  return static_cast<double>(random() >> 32) < probability * 4294967296.0;
}

double Uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 32) / 4294967296.0;
}

enum class Steps { kFaces, kCorners };

// Components of the voxels of `phase` (0 or 1) in the box padded by one.
int64_t CountComponents(const ReferenceMask& mask, bool phase, Steps steps) {
  const LatticePoint low = {-1, -1, -1}, high = {mask.nx, mask.ny, mask.nz};
  ReferenceMask reached = EmptyMask(mask.nx + 2, mask.ny + 2, mask.nz + 2);
  std::vector<LatticePoint> open;
  const auto reach = [&](LatticePoint p) {
    if (p.x < low.x || p.y < low.y || p.z < low.z) return;
    if (p.x > high.x || p.y > high.y || p.z > high.z) return;
    uint8_t& seen = reached.voxels[reached.Index(p.x + 1, p.y + 1, p.z + 1)];
    if (seen != 0 || mask.Contains(p.x, p.y, p.z) != phase) return;
    seen = 1;
    open.push_back(p);
  };
  int64_t components = 0;
  ForEachVoxel(low, high, [&](LatticePoint start) {
    reach(start);
    if (open.empty()) return;
    ++components;
    while (!open.empty()) {
      const LatticePoint p = open.back();
      open.pop_back();
      ForEachVoxel({-1, -1, -1}, {1, 1, 1}, [&](LatticePoint step) {
        const int moved = std::abs(step.x) + std::abs(step.y) + std::abs(step.z);
        if (steps == Steps::kCorners || moved == 1) reach(p + step);
      });
    }
  });
  return components;
}

// Voxels around the cell (a, b, c) of the complex, where an odd coordinate is the inside of voxel
// a / 2 and an even one the border between the voxels a / 2 - 1 and a / 2. Counts all and set ones.
struct Around {
  int all = 0;
  int set = 0;
};
Around VoxelsAround(const ReferenceMask& mask, LatticePoint cell) {
  const auto from = [](int32_t a) { return (a & 1) != 0 ? a / 2 : a / 2 - 1; };
  Around around;
  ForEachVoxel({from(cell.x), from(cell.y), from(cell.z)}, {cell.x / 2, cell.y / 2, cell.z / 2},
               [&](LatticePoint v) {
                 ++around.all;
                 around.set += mask.Contains(v.x, v.y, v.z) ? 1 : 0;
               });
  return around;
}

int64_t EulerOfCells(const ReferenceMask& mask, ObjectReach reach) {
  int64_t sum = 0;
  ForEachVoxel({0, 0, 0}, {2 * mask.nx, 2 * mask.ny, 2 * mask.nz}, [&](LatticePoint cell) {
    const Around around = VoxelsAround(mask, cell);
    const int dimension = (cell.x & 1) + (cell.y & 1) + (cell.z & 1);
    if (reach == ObjectReach::kCorner26) {
      if (around.set > 0) sum += dimension % 2 == 0 ? 1 : -1;
    } else if (around.set == around.all) {
      sum += (3 - dimension) % 2 == 0 ? 1 : -1;
    }
  });
  return sum;
}

}  // namespace

ReferenceMask MaskOfBits(int32_t nx, int32_t ny, int32_t nz, uint64_t bits) {
  ReferenceMask mask = EmptyMask(nx, ny, nz);
  for (size_t n = 0; n < mask.voxels.size(); ++n) mask.voxels[n] = bits >> n & 1;
  return mask;
}

ReferenceMask RandomMask(uint64_t seed, int32_t nx, int32_t ny, int32_t nz, double density) {
  std::mt19937_64 random(seed);
  ReferenceMask mask = EmptyMask(nx, ny, nz);
  for (uint8_t& voxel : mask.voxels) voxel = Chance(random, density) ? 1 : 0;
  return mask;
}

ReferenceMask RandomBallMask(uint64_t seed, int32_t nx, int32_t ny, int32_t nz, int balls,
                             double largest_radius) {
  std::mt19937_64 random(seed);
  ReferenceMask mask = EmptyMask(nx, ny, nz);
  for (int n = 0; n < balls; ++n) {
    const double cx = Uniform(random, 0, nx), cy = Uniform(random, 0, ny);
    const double cz = Uniform(random, 0, nz), r = Uniform(random, 1, largest_radius);
    ForEachVoxel({0, 0, 0}, {nx - 1, ny - 1, nz - 1}, [&](LatticePoint v) {
      const double dx = v.x - cx, dy = v.y - cy, dz = v.z - cz;
      if (dx * dx + dy * dy + dz * dz <= r * r) mask.voxels[mask.Index(v.x, v.y, v.z)] = 1;
    });
  }
  return mask;
}

BettiNumbers ReferenceMaskBetti(const ReferenceMask& mask, ObjectReach reach) {
  const bool corners = reach == ObjectReach::kCorner26;
  BettiNumbers betti;
  betti.components = CountComponents(mask, true, corners ? Steps::kCorners : Steps::kFaces);
  betti.cavities = CountComponents(mask, false, corners ? Steps::kFaces : Steps::kCorners) - 1;
  betti.loops = betti.components + betti.cavities - EulerOfCells(mask, reach);
  return betti;
}

namespace {

// The corners of a phase of a mask: those that touch it, but for the lower ends of bad edges.
class Corners {
 public:
  Corners(const ReferenceMask& mask, bool phase) : mask_(mask), phase_(phase) {}

  bool Has(LatticePoint c) const {
    if (!Touches(c)) return false;
    return std::ranges::none_of(kSteps, [&](LatticePoint u) { return IsBadEdge(c, u); });
  }

  // Whether c and c + u touch the phase, and none of the four voxels around their edge is of it.
  bool IsBadEdge(LatticePoint c, LatticePoint u) const {
    const LatticePoint low = {c.x - 1 + u.x, c.y - 1 + u.y, c.z - 1 + u.z};
    return Touches(c) && Touches(c + u) && !Any(low, c);
  }

 private:
  static constexpr LatticePoint kSteps[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  bool Touches(LatticePoint c) const { return Any({c.x - 1, c.y - 1, c.z - 1}, c); }
  bool Any(LatticePoint low, LatticePoint high) const {
    bool any = false;
    ForEachVoxel(low, high,
                 [&](LatticePoint v) { any |= mask_.Contains(v.x, v.y, v.z) == phase_; });
    return any;
  }

  const ReferenceMask& mask_;
  const bool phase_;
};

}  // namespace

std::vector<LatticePoint> ReferenceExactPoints(const ReferenceMask& mask, ObjectReach reach) {
  const bool corners_touch = reach == ObjectReach::kCorner26;
  const Corners corners(mask, corners_touch);
  std::vector<LatticePoint> points;
  ForEachVoxel({0, 0, 0}, {mask.nx, mask.ny, mask.nz}, [&](LatticePoint c) {
    if (corners.Has(c) == corners_touch) points.push_back({2 * c.x, 2 * c.y, 2 * c.z});
    if (mask.Contains(c.x, c.y, c.z)) points.push_back({2 * c.x + 1, 2 * c.y + 1, 2 * c.z + 1});
  });
  return points;
}

ReferenceMask Refined(const ReferenceMask& mask) {
  ReferenceMask refined = EmptyMask(2 * mask.nx, 2 * mask.ny, 2 * mask.nz);
  ForEachVoxel({0, 0, 0}, {refined.nx - 1, refined.ny - 1, refined.nz - 1}, [&](LatticePoint v) {
    refined.voxels[refined.Index(v.x, v.y, v.z)] = mask.Contains(v.x / 2, v.y / 2, v.z / 2) ? 1 : 0;
  });
  return refined;
}

}  // namespace bccskel::test
