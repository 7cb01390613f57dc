#include "core/export/surface/cell_grid.h"

#include <algorithm>
#include <span>

#include "core/exec/status_macros.h"
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

// The part of a halved brick that consists of one brick's cells.
void Halve(const CellGrid::Fills& from, const BrickCoordinates& brick, CellGrid::Fills& to) {
  for (int z = 0; z < kBrickZ; z += 2) {
    for (int y = 0; y < kBrickY; y += 2) {
      for (int x = 0; x < kBrickX; x += 2) {
        int sum = 7;  // rounds up
        for (int n = 0; n < 8; ++n)
          sum += from[CellAt(x + (n & 1), y + (n >> 1 & 1), z + (n >> 2))];
        to[CellAt(((brick.bx & 1) * kBrickX + x) / 2, ((brick.by & 1) * kBrickY + y) / 2,
                  ((brick.bz & 1) * kBrickZ + z) / 2)] = static_cast<uint8_t>(sum / 8);
      }
    }
  }
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

constexpr size_t kBricksAtOnce = 256;

BrickKey Odd(const BrickCoordinates& brick) {
  return BrickKey({brick.bx, brick.by, brick.bz, Sublattice::kOdd});
}

void MakeUnique(std::vector<BrickKey>& keys) {
  std::ranges::sort(keys);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

CellGrid::Fills FillsOf(const Volume& object, BrickCoordinates brick) {
  BrickBits points;
  brick.sublattice = Sublattice::kEven;
  if (const auto even = object.Find(BrickKey(brick))) {
    points = object.bricks()[*even];
    KeepThoseWithoutOddNeighbors(object, brick, points);
  }
  brick.sublattice = Sublattice::kOdd;
  if (const auto odd = object.Find(BrickKey(brick))) points |= object.bricks()[*odd];
  CellGrid::Fills fills = {};
  points.ForEachSetBit([&](int bit) { fills[static_cast<size_t>(bit)] = 255; });
  return fills;
}

}  // namespace

absl::StatusOr<CellGrid> CellGrid::Of(const Volume& object, const exec::Context& context) {
  CellGrid grid;
  for (const BrickKey key : object.keys()) grid.keys_.push_back(Odd(key.coordinates()));
  MakeUnique(grid.keys_);
  grid.fills_.resize(grid.keys_.size());
  const auto fill = [&](exec::Share share) {
    for (size_t n = share.begin; n < share.end; ++n) {
      grid.fills_[n] = FillsOf(object, grid.keys_[n].coordinates());
    }
  };
  BCCSKEL_RETURN_IF_ERROR(context.ForEachShare(grid.keys_.size(), kBricksAtOnce, fill));
  return grid;
}

absl::StatusOr<CellGrid> CellGrid::Halved(const exec::Context& context) const {
  CellGrid grid;
  grid.edge_ = 2 * edge_;
  for (const BrickKey key : keys_) {
    const BrickCoordinates brick = key.coordinates();
    grid.keys_.push_back(Odd({brick.bx / 2, brick.by / 2, brick.bz / 2, Sublattice::kOdd}));
  }
  MakeUnique(grid.keys_);
  grid.fills_.resize(grid.keys_.size());
  const auto fill = [&](exec::Share share) {
    for (size_t n = share.begin; n < share.end; ++n) {
      grid.fills_[n] = HalvedFills(grid.keys_[n].coordinates());
    }
  };
  BCCSKEL_RETURN_IF_ERROR(context.ForEachShare(grid.keys_.size(), kBricksAtOnce, fill));
  return grid;
}

CellGrid::Fills CellGrid::HalvedFills(const BrickCoordinates& half) const {
  Fills fills = {};
  for (int n = 0; n < 8; ++n) {
    const BrickCoordinates brick = {2 * half.bx + (n & 1), 2 * half.by + (n >> 1 & 1),
                                    2 * half.bz + (n >> 2), Sublattice::kOdd};
    const std::optional<size_t> found = Find(brick.bx, brick.by, brick.bz);
    if (found) Halve(fills_[*found], brick, fills);
  }
  return fills;
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
