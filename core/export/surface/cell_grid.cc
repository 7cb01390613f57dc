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

constexpr int PlaceOf(int cell, size_t axis) { return cell / kSteps[axis] % kSizes[axis]; }

// 1 for cells whose neighbor along an axis lies in the same brick.
constexpr auto kHasNext = [] {
  std::array<std::array<uint8_t, kBrickPoints>, 3> has_next = {};
  for (size_t axis = 0; axis < 3; ++axis) {
    for (int cell = 0; cell < kBrickPoints; ++cell) {
      has_next[axis][static_cast<size_t>(cell)] = PlaceOf(cell, axis) + 1 < kSizes[axis];
    }
  }
  return has_next;
}();

// Pairs of neighboring cells along an axis inside of a brick of which one is empty. Without
// branches, so that compilers vectorize it.
int FacesInside(const CellGrid::Fills& fills, size_t axis) {
  const auto step = static_cast<size_t>(kSteps[axis]);
  int faces = 0;
  for (size_t cell = 0; cell + step < kBrickPoints; ++cell) {
    faces += kHasNext[axis][cell] & ((fills[cell] == 0) ^ (fills[cell + step] == 0));
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

// The cells of a brick and those after them along each axis: the even points that have one of these
// odd points as a neighbor. Neighbors in other bricks are not seen.
BrickBits WithNextCells(BrickBits cells) {
  constexpr uint64_t kFirstInX = 0x0001'0001'0001'0001;
  for (uint64_t& layer : cells.words) {
    layer |= layer << 1 & ~kFirstInX;
    layer |= layer << kBrickX;
  }
  for (size_t z = cells.words.size(); --z > 0;) cells.words[z] |= cells.words[z - 1];
  return cells;
}

// Of the even points of a brick.
void KeepThoseWithoutOddNeighbors(const Volume& object, const BrickCoordinates& brick,
                                  BrickBits& points) {
  const BrickKey odd({brick.bx, brick.by, brick.bz, Sublattice::kOdd});
  if (const auto found = object.Find(odd)) points &= ~WithNextCells(object.bricks()[*found]);
  const BrickBits candidates = points;
  candidates.ForEachSetBit([&](int bit) {
    const bool inside = PlaceOf(bit, 0) > 0 && PlaceOf(bit, 1) > 0 && PlaceOf(bit, 2) > 0;
    if (inside) return;  // all its neighbors are in that brick
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
