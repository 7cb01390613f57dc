#include "core/distance/exact_radius.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "core/distance/nearest_background.h"

// Does:  looks for the nearest background point among the bricks around a point.
// Why it is right: the search reaches farther until a background point is known within its reach,
//   and every brick that could hold a nearer one is looked at. Sums are formed in the order of
//   euclidean_scan.cc, so both give the same bits.
// Cost:  full bricks cost nothing after the first point of a brick, bricks beyond the bound a
//   comparison, the others some 15 ns. All of a ball's surface is equally near to its center: there
//   rows taken one by one were a third of the whole job's time (850,000 points).

namespace bccskel {
namespace {

// Rounding must not take a point out of reach.
constexpr double kRoundingSlack = 1.01;
// In lattice units, where nothing is known yet.
constexpr double kFirstReach = 16;
// The next point's radius is mostly like the last one's.
constexpr double kReachFactor = 1.25;

constexpr std::array<int32_t, 3> kBrickCells = {kBrickX, kBrickY, kBrickZ};

// As in euclidean_scan.cc.
float Square(double unit, int32_t n) {
  const double length = unit * n;
  return static_cast<float>(length * length);
}

// Of a brick's cells along an axis, the first one at `low`.
template <size_t kCells>
std::array<float, kCells> SquaresOfCells(double unit, int32_t low) {
  std::array<float, kCells> squares;
  for (size_t cell = 0; cell < kCells; ++cell) {
    squares[cell] = Square(unit, low + 2 * static_cast<int32_t>(cell));
  }
  return squares;
}

}  // namespace

ExactRadius::ExactRadius(const Volume& object, const DistanceField& field)
    : object_(object),
      field_(field),
      scale_(AxisScaleOf(object.placement())),
      square_x_(static_cast<float>(scale_[0] * scale_[0])) {
  last_.at = {-1, -1, -1};  // background, like everything outside the extent
}

float ExactRadius::At(LatticePoint p) {
  if (!object_.Contains(p)) return 0;
  const BrickAddress address = AddressOf(p);
  if (field_.kind() == DistanceKind::kEuclidean) {
    const BrickIndex brick = *object_.Find(BrickKey(address.brick));
    return static_cast<float>(field_.ToLatticeUnits(field_.At(brick, address.bit)));
  }
  const double guess = std::max(kFirstReach, kReachFactor * std::sqrt(double{last_.squared}));
  Nearest nearest = {last_.at, SquaredBetween(p, last_.at)};
  const auto bound = [&] { return kRoundingSlack * std::sqrt(double{nearest.squared}); };
  for (double reach = std::min(guess, bound());; reach = std::min(2 * reach, bound())) {
    OpenWindow(address.brick, reach);
    SearchWindow(p, nearest);
    if (bound() <= reach) break;
  }
  last_ = nearest;
  return static_cast<float>(std::sqrt(double{nearest.squared}));
}

float ExactRadius::SquaredBetween(LatticePoint a, LatticePoint b) const {
  const auto x = static_cast<float>(std::abs(a.x - b.x));
  return x * x * square_x_ + Square(scale_[1], a.y - b.y) + Square(scale_[2], a.z - b.z);
}

void ExactRadius::OpenWindow(BrickCoordinates home, double reach) {
  home.sublattice = Sublattice::kEven;
  if (home == window_.home && reach <= window_.reach) return;
  window_.home = home;
  window_.reach = reach;
  const std::array<int32_t, 3> at = {home.bx, home.by, home.bz};
  for (size_t axis = 0; axis < 3; ++axis) {
    const double bricks = (reach / scale_[axis] + 2) / (2 * kBrickCells[axis]);
    const auto around = static_cast<int32_t>(std::ceil(bricks));
    window_.low[axis] = at[axis] - around;
    window_.size[axis] = 2 * around + 1;
  }
  window_.bricks.clear();
  for (int32_t z = 0; z < window_.size[2]; ++z) {
    for (int32_t y = 0; y < window_.size[1]; ++y) AddWindowRow(y, z);
  }
}

// Both sublattices in turn; what is not stored is the padding brick. Bricks of a row lie one after
// the other in a volume.
void ExactRadius::FindWindowRow(int32_t by, int32_t bz) {
  row_.assign(2 * static_cast<size_t>(window_.size[0]),
              static_cast<BrickIndex>(object_.brick_count()));
  if (by < 0 || bz < 0) return;
  const std::span<const BrickKey> keys = object_.keys();
  const BrickKey first({std::max(window_.low[0], 0), by, bz, Sublattice::kEven});
  auto key = std::ranges::lower_bound(keys, first);
  for (; key != keys.end(); ++key) {
    const BrickCoordinates brick = key->coordinates();
    if (brick.bz != bz || brick.by != by || brick.bx >= window_.low[0] + window_.size[0]) return;
    const auto x = static_cast<size_t>(brick.bx - window_.low[0]);
    row_[2 * x + static_cast<size_t>(brick.sublattice)] =
        static_cast<BrickIndex>(key - keys.begin());
  }
}

void ExactRadius::AddWindowRow(int32_t y, int32_t z) {
  FindWindowRow(window_.low[1] + y, window_.low[2] + z);
  const std::span<const BrickBits> bricks = object_.padded_bricks();
  const auto at_y = static_cast<uint32_t>(2 * y), at_z = static_cast<uint32_t>(2 * z);
  for (uint32_t x = 0; x < row_.size(); ++x) {
    if (IsFull(bricks[row_[x]])) continue;
    const uint32_t odd = x & 1;
    window_.bricks.push_back({row_[x], {x, at_y + odd, at_z + odd}});
  }
}

// Along each axis, how far a point is from the window's bricks and, along y and z, their rows.
void ExactRadius::MeasureAxes(LatticePoint p) {
  MeasureGaps(0, p.x);
  MeasureGaps(1, p.y);
  MeasureGaps(2, p.z);
  for (size_t axis : {1, 2}) rows_[axis - 1].resize(gaps_[axis].size());
  for (size_t n = 0; n < rows_[0].size(); ++n) {
    const auto squares = SquaresOfCells<kBrickY>(scale_[1], LowAt(1, n) - p.y);
    for (size_t row = 0; row < squares.size() * kBrickZ; ++row) {
      rows_[0][n][row] = squares[row % squares.size()];
    }
  }
  for (size_t n = 0; n < rows_[1].size(); ++n) {
    const auto squares = SquaresOfCells<kBrickZ>(scale_[2], LowAt(2, n) - p.z);
    for (size_t row = 0; row < squares.size() * kBrickY; ++row) {
      rows_[1][n][row] = squares[row / kBrickY];
    }
  }
}

void ExactRadius::MeasureGaps(size_t axis, int32_t from) {
  gaps_[axis].resize(2 * static_cast<size_t>(window_.size[axis]));
  for (size_t n = 0; n < gaps_[axis].size(); ++n) {
    const int32_t low = LowAt(axis, n) - from, high = low + 2 * (kBrickCells[axis] - 1);
    const int32_t gap = std::max({low, -high, 0});
    const auto x = static_cast<float>(gap);
    gaps_[axis][n] = axis == 0 ? x * x * square_x_ : Square(scale_[axis], gap);
  }
}

// The first cell along an axis of a place in the window.
int32_t ExactRadius::LowAt(size_t axis, size_t n) const {
  const int32_t brick = window_.low[axis] + static_cast<int32_t>(n >> 1);
  return brick * 2 * kBrickCells[axis] + static_cast<int32_t>(n & 1);
}

// Gaps are added up in the order in which squares are, so rounding cannot put one above the other.
void ExactRadius::SearchWindow(LatticePoint p, Nearest& nearest) {
  MeasureAxes(p);
  for (const WindowBrick& brick : window_.bricks) {
    const float gap = gaps_[0][brick.at[0]] + gaps_[1][brick.at[1]] + gaps_[2][brick.at[2]];
    if (gap < nearest.squared) SearchBrick(p, brick, nearest);
  }
}

void ExactRadius::SearchBrick(LatticePoint p, const WindowBrick& brick, Nearest& nearest) const {
  const int32_t low = LowAt(0, brick.at[0]);
  const RowSearch search = {.place = p.x - low,
                            .square_x = square_x_,
                            .squared_y = rows_[0][brick.at[1]].data(),
                            .squared_z = rows_[1][brick.at[2]].data(),
                            .below = nearest.squared};
  const NearestCell found = FindNearestBackground(search, object_.padded_bricks()[brick.index]);
  if (found.squared >= nearest.squared) return;
  const int32_t i = found.bit & 15, j = found.bit >> 4 & 3, k = found.bit >> 6;
  nearest = {{low + 2 * i, LowAt(1, brick.at[1]) + 2 * j, LowAt(2, brick.at[2]) + 2 * k},
             found.squared};
}

absl::StatusOr<std::vector<float>> ExactRadii(const Volume& thin, const Volume& object,
                                              const DistanceField& field,
                                              const exec::Context& context) {
  std::vector<LatticePoint> points;
  thin.ForEachPoint([&](LatticePoint p) { points.push_back(p); });
  std::vector<float> radii(points.size());
  context.Run([&](int worker) {
    ExactRadius radius(object, field);
    const exec::Share mine = exec::ShareOf(points.size(), worker, context.threads());
    for (size_t n = mine.begin; n < mine.end; ++n) {
      if (n % 64 == 0 && context.ShouldStop()) return;
      radii[n] = radius.At(points[n]);
    }
  });
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  return radii;
}

}  // namespace bccskel
