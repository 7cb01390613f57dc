#include <algorithm>
#include <limits>

#include "absl/strings/str_format.h"
#include "core/export/surface/cell_grid.h"

namespace bccskel {
namespace {

// The corners of cells are numbered like the cells below them, so a corner has cells at 0 and 1
// along each axis. A brick's corners touch cells of the bricks after it; whether a cell is all that
// is there is seen one cell farther on either side.
constexpr int kPadX = kBrickX + 3, kPadY = kBrickY + 3, kPadZ = kBrickZ + 3;
constexpr std::array<int, 3> kPadSteps = {1, kPadX, kPadX* kPadY};
constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

using Ids = std::array<uint32_t, kBrickPoints>;

constexpr int PaddedAt(int x, int y, int z) {
  return (x + 1) + kPadX * ((y + 1) + kPadY * (z + 1));
}

// The fills of a brick and of the cells around it.
class PaddedBrick {
 public:
  PaddedBrick(const CellGrid& grid, const BrickCoordinates& brick) {
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const auto from = grid.Find(brick.bx + dx, brick.by + dy, brick.bz + dz);
          if (from) Copy(grid.fills(*from), dx * kBrickX, dy * kBrickY, dz * kBrickZ);
        }
      }
    }
  }
  int operator[](int at) const { return fills_[static_cast<size_t>(at)]; }

 private:
  // The cells of a brick whose first one lies at (x0, y0, z0).
  void Copy(const CellGrid::Fills& fills, int x0, int y0, int z0) {
    for (int z = std::max(z0, -1); z < std::min(z0 + kBrickZ, kBrickZ + 2); ++z) {
      for (int y = std::max(y0, -1); y < std::min(y0 + kBrickY, kBrickY + 2); ++y) {
        const int x = std::max(x0, -1), end = std::min(x0 + kBrickX, kBrickX + 2);
        std::copy_n(&fills[CellAt(x - x0, y - y0, z - z0)], end - x,
                    &fills_[static_cast<size_t>(PaddedAt(x, y, z))]);
      }
    }
  }

  std::array<uint8_t, kPadX* kPadY* kPadZ> fills_ = {};
};

class CellSurface {
 public:
  explicit CellSurface(const CellGrid& grid) : grid_(grid) {
    for (const BrickKey key : grid.keys()) {
      const BrickCoordinates b = key.coordinates();
      for (int n = 0; n < 8; ++n) {
        keys_.push_back(BrickKey({b.bx - (n & 1), b.by - (n >> 1 & 1), b.bz - (n >> 2), kOdd}));
      }
    }
    std::ranges::sort(keys_);
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    ids_.resize(keys_.size());
  }

  size_t brick_count() const { return keys_.size(); }

  // Needs: bricks in order.
  void AddVertices(size_t brick) {
    const BrickCoordinates at = keys_[brick].coordinates();
    const PaddedBrick cells(grid_, at);
    ForEachCorner([&](int x, int y, int z) {
      uint32_t& id = ids_[brick][CellAt(x, y, z)];
      id = kNone;
      const int low = PaddedAt(x, y, z);
      if (!IsCut(cells, low)) return;
      id = static_cast<uint32_t>(mesh_.vertices.size());
      const SurfaceVertex within = MeanCrossing(cells, low);
      mesh_.vertices.push_back({Lattice(at.bx * kBrickX + x, within[0]),
                                Lattice(at.by * kBrickY + y, within[1]),
                                Lattice(at.bz * kBrickZ + z, within[2])});
    });
  }

  // Needs: all vertices. The faces around the last cell of the eight at each corner.
  void AddTriangles(size_t brick) {
    const BrickCoordinates at = keys_[brick].coordinates();
    const PaddedBrick cells(grid_, at);
    std::array<const Ids*, 8> ids = {};
    for (int n = 0; n < 8; ++n) ids[static_cast<size_t>(n)] = IdsAfter(at, n);
    ForEachCorner([&](int x, int y, int z) {
      if (ids_[brick][CellAt(x, y, z)] == kNone) return;
      for (size_t axis = 0; axis < 3; ++axis) AddFace(cells, ids, {x, y, z}, axis);
    });
  }

  bool TooLarge() const { return mesh_.vertices.size() >= kNone - kBrickPoints; }
  SurfaceMesh Take() && { return std::move(mesh_); }

 private:
  static constexpr Sublattice kOdd = Sublattice::kOdd;

  template <typename Visit>
  static void ForEachCorner(Visit visit) {
    for (int z = 0; z < kBrickZ; ++z) {
      for (int y = 0; y < kBrickY; ++y) {
        for (int x = 0; x < kBrickX; ++x) visit(x, y, z);
      }
    }
  }

  static int CornerStep(int n) {
    return (n & 1) * kPadSteps[0] + (n >> 1 & 1) * kPadSteps[1] + (n >> 2) * kPadSteps[2];
  }

  static bool IsCut(const PaddedBrick& cells, int low) {
    int full = 0;
    for (int n = 0; n < 8; ++n) full += cells[low + CornerStep(n)] != 0;
    return full != 0 && full != 8;
  }

  // How far from a cell's center the surface lies toward an empty cell, `step` away, in cells.
  static float Reach(const PaddedBrick& cells, int at, int step) {
    const float full = static_cast<float>(cells[at]) / 255;
    const bool alone = cells[at - step] == 0;
    return alone ? full / 2 : std::max(full - 0.5f, -0.25f);
  }

  // Of the up to 12 steps between the eight cells of a corner, from the center of the lowest.
  static SurfaceVertex MeanCrossing(const PaddedBrick& cells, int low) {
    SurfaceVertex sum = {};
    float count = 0;
    for (int n = 0; n < 8; ++n) {
      for (size_t axis = 0; axis < 3; ++axis) {
        if ((n >> axis & 1) != 0) continue;
        const int a = low + CornerStep(n), step = kPadSteps[axis];
        if ((cells[a] == 0) == (cells[a + step] == 0)) continue;
        for (size_t k = 0; k < 3; ++k) sum[k] += static_cast<float>(n >> k & 1);
        sum[axis] += cells[a] != 0 ? Reach(cells, a, step) : 1 - Reach(cells, a + step, -step);
        count += 1;
      }
    }
    return {sum[0] / count, sum[1] / count, sum[2] / count};
  }

  // The center of the finest cell 0 is the odd point 1.
  float Lattice(int cell, float within) const {
    return grid_.edge() * (static_cast<float>(cell) + within + 0.5f);
  }

  const Ids* IdsAfter(const BrickCoordinates& b, int n) const {
    const BrickKey key({b.bx + (n & 1), b.by + (n >> 1 & 1), b.bz + (n >> 2), kOdd});
    const auto at = std::ranges::lower_bound(keys_, key);
    if (at == keys_.end() || *at != key) return nullptr;
    return &ids_[static_cast<size_t>(at - keys_.begin())];
  }

  static uint32_t IdAt(const std::array<const Ids*, 8>& ids, const std::array<int, 3>& p) {
    const int n = (p[0] / kBrickX) | (p[1] / kBrickY) << 1 | (p[2] / kBrickZ) << 2;
    return (*ids[static_cast<size_t>(n)])[CellAt(p[0] % kBrickX, p[1] % kBrickY, p[2] % kBrickZ)];
  }

  // Between two cells after the corner in both other axes: its four corners, counterclockwise seen
  // from the second cell.
  void AddFace(const PaddedBrick& cells, const std::array<const Ids*, 8>& ids,
               const std::array<int, 3>& low, size_t axis) {
    const size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
    const int a = PaddedAt(low[0], low[1], low[2]) + kPadSteps[next] + kPadSteps[last];
    const bool first_is_full = cells[a] != 0;
    if (first_is_full == (cells[a + kPadSteps[axis]] != 0)) return;
    std::array<uint32_t, 4> ring;
    for (size_t n = 0; n < 4; ++n) {
      std::array<int, 3> corner = low;
      corner[next] += n == 1 || n == 2;
      corner[last] += n >= 2;
      ring[n] = IdAt(ids, corner);
    }
    if (!first_is_full) std::swap(ring[1], ring[3]);
    mesh_.triangles.push_back({ring[0], ring[1], ring[2]});
    mesh_.triangles.push_back({ring[0], ring[2], ring[3]});
  }

  const CellGrid& grid_;
  std::vector<BrickKey> keys_;  // of the bricks with corners of cells that have points
  std::vector<Ids> ids_;
  SurfaceMesh mesh_;
};

}  // namespace

absl::StatusOr<SurfaceMesh> ExtractCellSurface(const CellGrid& grid, const exec::Context& context) {
  CellSurface surface(grid);
  for (size_t n = 0; n < surface.brick_count(); ++n) {
    if (n % 256 == 0 && context.ShouldStop()) return context.StopStatus();
    if (surface.TooLarge()) {
      return absl::ResourceExhaustedError(
          absl::StrFormat("the surface has more than the %d vertices of the limit", kNone));
    }
    surface.AddVertices(n);
  }
  for (size_t n = 0; n < surface.brick_count(); ++n) {
    if (n % 256 == 0 && context.ShouldStop()) return context.StopStatus();
    surface.AddTriangles(n);
  }
  return std::move(surface).Take();
}

}  // namespace bccskel
