#include "core/export/surface/cell_grid.h"

#include <algorithm>
#include <bit>
#include <map>
#include <span>

#include "core/lattice/directions.h"

namespace bccskel {
namespace {

constexpr int kSteps[3] = {1, kBrickX, kBrickX* kBrickY};  // to the next cell, in bits
constexpr int kSizes[3] = {kBrickX, kBrickY, kBrickZ};

int PlaceOf(int cell, size_t axis) { return cell / kSteps[axis] % kSizes[axis]; }

// Pairs of neighboring cells along an axis inside of a brick of which one is empty.
int FacesInside(const CellGrid::Fills& fills, size_t axis) {
  int faces = 0;
  for (int cell = 0; cell < kBrickPoints; ++cell) {
    if (PlaceOf(cell, axis) + 1 == kSizes[axis]) continue;
    const size_t here = static_cast<size_t>(cell);
    const size_t next = here + static_cast<size_t>(kSteps[axis]);
    faces += (fills[here] == 0) != (fills[next] == 0);
  }
  return faces;
}

// Where a cell of a brick lies when bricks are halved.
int HalfPlaceOf(int cell, const BrickCoordinates& brick) {
  const int x = (brick.bx & 1) * kBrickX + PlaceOf(cell, 0);
  const int y = (brick.by & 1) * kBrickY + PlaceOf(cell, 1);
  const int z = (brick.bz & 1) * kBrickZ + PlaceOf(cell, 2);
  return (x / 2) * kSteps[0] + (y / 2) * kSteps[1] + (z / 2) * kSteps[2];
}

// Of the even points of a brick.
void KeepThoseWithoutOddNeighbors(const Volume& object, const BrickCoordinates& brick,
                                  BrickBits& points) {
  // Most have the one in the same cell; the others are looked up one by one.
  const BrickKey odd({brick.bx, brick.by, brick.bz, Sublattice::kOdd});
  if (const auto found = object.Find(odd)) {
    points &= ~object.bricks()[*found];
  }
  const BrickBits candidates = points;
  candidates.ForEachSetBit([&](int bit) {
    const LatticePoint p = PointOf(brick, bit);
    for (const LatticePoint& step : std::span(kDirections14).first(8)) {
      if (object.Contains({p.x + step.x, p.y + step.y, p.z + step.z})) return points.Clear(bit);
    }
  });
}

}  // namespace

CellGrid CellGrid::Of(const Volume& object) {
  std::map<BrickKey, Fills> cells;
  for (size_t n = 0; n < object.brick_count(); ++n) {
    const BrickCoordinates brick = object.keys()[n].coordinates();
    const BrickKey key({brick.bx, brick.by, brick.bz, Sublattice::kOdd});
    BrickBits points = object.bricks()[n];
    if (brick.sublattice == Sublattice::kEven) {
      KeepThoseWithoutOddNeighbors(object, brick, points);
      if (points.Empty()) continue;
    }
    Fills& fills = cells[key];
    points.ForEachSetBit([&](int bit) { fills[static_cast<size_t>(bit)] = 255; });
  }
  CellGrid grid;
  grid.keys_.reserve(cells.size());
  grid.fills_.reserve(cells.size());
  for (const auto& [key, fills] : cells) {
    grid.keys_.push_back(key);
    grid.fills_.push_back(fills);
  }
  return grid;
}

CellGrid CellGrid::Halved() const {
  using Sums = std::array<uint16_t, kBrickPoints>;
  std::map<BrickKey, Sums> sums;
  for (size_t n = 0; n < keys_.size(); ++n) {
    const BrickCoordinates brick = keys_[n].coordinates();
    Sums& into = sums[BrickKey({brick.bx / 2, brick.by / 2, brick.bz / 2, Sublattice::kOdd})];
    for (int cell = 0; cell < kBrickPoints; ++cell) {
      uint16_t& sum = into[static_cast<size_t>(HalfPlaceOf(cell, brick))];
      sum = static_cast<uint16_t>(sum + fills_[n][static_cast<size_t>(cell)]);
    }
  }
  CellGrid grid;
  grid.edge_ = 2 * edge_;
  for (const auto& [key, cells] : sums) {
    grid.keys_.push_back(key);
    std::ranges::transform(cells, grid.fills_.emplace_back().begin(),
                           [](uint16_t sum) { return static_cast<uint8_t>((sum + 7) / 8); });
  }
  return grid;
}

double CellGrid::TriangleEstimate() const {
  double faces = 0;
  for (const Fills& fills : fills_) {
    for (size_t axis = 0; axis < 3; ++axis) {
      faces += static_cast<double>(FacesInside(fills, axis)) * kSizes[axis] / (kSizes[axis] - 1);
    }
  }
  return 2 * faces;
}

std::optional<size_t> CellGrid::Find(int32_t bx, int32_t by, int32_t bz) const {
  if (bx < 0 || by < 0 || bz < 0) return std::nullopt;
  const BrickKey key({bx, by, bz, Sublattice::kOdd});
  const auto at = std::ranges::lower_bound(keys_, key);
  if (at == keys_.end() || *at != key) return std::nullopt;
  return static_cast<size_t>(at - keys_.begin());
}

}  // namespace bccskel
