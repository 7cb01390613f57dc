#include "core/distance/exact_radius.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

// Does:  looks for the nearest background point among the bricks around a point.
// Why it is right: a background point is known that lies no farther than the chamfer distance, and
//   one from the search before; every brick that could hold a nearer one is looked at. Sums are
//   formed in the order of euclidean_scan.cc, so both give the same bits.
// Cost:  full bricks and bricks beyond the bound cost a comparison; of the others, rows are words.

namespace bccskel {
namespace {

// Counts are lengths of steps rounded to whole numbers.
constexpr double kRoundingSlack = 1.01;

constexpr std::array<int32_t, 3> kBrickCells = {kBrickX, kBrickY, kBrickZ};

// As in euclidean_scan.cc.
float Square(double unit, int32_t n) {
  const double length = unit * n;
  return static_cast<float>(length * length);
}

// The set bit of a row nearest to a place; even numbers are the bits' places. Needs: row != 0.
int32_t NearestBit(uint32_t row, int32_t place) {
  const int32_t below = place >> 1;  // floor
  if (below < 0) return std::countr_zero(row);
  const uint32_t low = below >= 15 ? row : row & ((2u << below) - 1);
  if (low == 0) return std::countr_zero(row);
  const int32_t left = std::bit_width(low) - 1;
  const uint32_t high = row & ~low;
  if (high == 0) return left;
  const int32_t right = std::countr_zero(high);
  return place - 2 * left <= 2 * right - place ? left : right;
}

bool IsFull(const BrickBits& bits) {
  uint64_t all = ~uint64_t{0};
  for (uint64_t word : bits.words) all &= word;
  return ~all == 0;
}

}  // namespace

ExactRadius::ExactRadius(const Volume& object, const DistanceField& field)
    : object_(object),
      field_(field),
      scale_(AxisScaleOf(object.placement())),
      chamfer_factor_(kRoundingSlack * (field.kind() == DistanceKind::kChamferOptimal
                                            ? LargestOverestimate(scale_)
                                            : 1)),
      square_x_(static_cast<float>(scale_[0] * scale_[0])) {
  last_.at = {-1, -1, -1};  // background, like everything outside the extent
}

float ExactRadius::At(LatticePoint p) {
  if (!object_.Contains(p)) return 0;
  const BrickAddress address = AddressOf(p);
  const BrickIndex brick = *object_.Find(BrickKey(address.brick));
  if (field_.kind() == DistanceKind::kEuclidean) {
    return static_cast<float>(field_.ToLatticeUnits(field_.At(brick, address.bit)));
  }
  Nearest nearest = {last_.at, SquaredBetween(p, last_.at)};
  const double bound =
      std::min(UpperBound(brick, address.bit), std::sqrt(double{nearest.squared}) * kRoundingSlack);
  OpenWindow(address.brick, bound);
  SearchWindow(p, nearest);
  last_ = nearest;
  return static_cast<float>(std::sqrt(double{nearest.squared}));
}

double ExactRadius::UpperBound(BrickIndex brick, int bit) const {
  return chamfer_factor_ * field_.ToLatticeUnits(field_.At(brick, bit));
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
  window_.bricks.assign(
      window_.IndexOf(window_.low[0], window_.low[1], window_.low[2] + window_.size[2]),
      static_cast<BrickIndex>(object_.brick_count()));
  for (int32_t z = 0; z < window_.size[2]; ++z) {
    for (int32_t y = 0; y < window_.size[1]; ++y) FillRow(window_.low[1] + y, window_.low[2] + z);
  }
}

// Bricks of a row lie one after the other in a volume.
void ExactRadius::FillRow(int32_t by, int32_t bz) {
  if (by < 0 || bz < 0) return;
  const std::span<const BrickKey> keys = object_.keys();
  const BrickKey first({std::max(window_.low[0], 0), by, bz, Sublattice::kEven});
  auto key = std::ranges::lower_bound(keys, first);
  for (; key != keys.end(); ++key) {
    const BrickCoordinates brick = key->coordinates();
    if (brick.bz != bz || brick.by != by || brick.bx >= window_.low[0] + window_.size[0]) return;
    window_.bricks[window_.IndexOf(brick.bx, by, bz) + static_cast<size_t>(brick.sublattice)] =
        static_cast<BrickIndex>(key - keys.begin());
  }
}

// The square of the least distance along an axis from a point to the places of a brick's cells.
float ExactRadius::SquaredGap(LatticePoint p, int axis, int32_t brick) const {
  const std::array<int32_t, 3> at = {p.x, p.y, p.z};
  const auto a = static_cast<size_t>(axis);
  const int32_t low = brick * 2 * kBrickCells[a], high = low + 2 * kBrickCells[a] - 1;
  const int32_t gap = std::max({low - at[a], at[a] - high, 0});
  return Square(scale_[a], gap);
}

void ExactRadius::SearchWindow(LatticePoint p, Nearest& nearest) const {
  const std::span<const BrickBits> bricks = object_.padded_bricks();
  for (int32_t bz = window_.low[2]; bz < window_.low[2] + window_.size[2]; ++bz) {
    const float z = SquaredGap(p, 2, bz);
    for (int32_t by = window_.low[1]; by < window_.low[1] + window_.size[1]; ++by) {
      const float yz = SquaredGap(p, 1, by) + z;
      if (yz >= nearest.squared) continue;
      for (int32_t bx = window_.low[0]; bx < window_.low[0] + window_.size[0]; ++bx) {
        if (SquaredGap(p, 0, bx) + yz >= nearest.squared) continue;
        const size_t index = window_.IndexOf(bx, by, bz);
        for (Sublattice sublattice : kSublattices) {
          const BrickBits& bits = bricks[window_.bricks[index + static_cast<size_t>(sublattice)]];
          if (!IsFull(bits)) SearchBrick(p, bits, {bx, by, bz, sublattice}, nearest);
        }
      }
    }
  }
}

void ExactRadius::SearchBrick(LatticePoint p, const BrickBits& bits, BrickCoordinates brick,
                              Nearest& nearest) const {
  const LatticePoint corner = PointOf(brick, 0);
  for (int k = 0; k < kBrickZ; ++k) {
    const uint64_t background = ~bits.words[static_cast<size_t>(k)];
    const int32_t at_z = corner.z + 2 * k;
    const float z = Square(scale_[2], at_z - p.z);
    if (background == 0 || z >= nearest.squared) continue;
    for (int j = 0; j < kBrickY; ++j) {
      const auto row = static_cast<uint32_t>(background >> (kBrickX * j) & 0xffff);
      const int32_t at_y = corner.y + 2 * j;
      const float y = Square(scale_[1], at_y - p.y);
      if (row == 0 || y + z >= nearest.squared) continue;
      const int32_t at_x = corner.x + 2 * NearestBit(row, p.x - corner.x);
      const auto x = static_cast<float>(std::abs(at_x - p.x));
      const float squared = x * x * square_x_ + y + z;
      if (squared < nearest.squared) nearest = {{at_x, at_y, at_z}, squared};
    }
  }
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
