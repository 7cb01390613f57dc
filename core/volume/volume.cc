#include "core/volume/volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/volume/count_points.h"

namespace bccskel {
namespace {

// The bits of a brick that lie inside the extent.
BrickBits InsideMask(const LatticeExtent& extent, BrickCoordinates brick) {
  const int32_t cells_x = std::min(kBrickX, extent.nx - brick.bx * kBrickX);
  const int32_t cells_y = std::min(kBrickY, extent.ny - brick.by * kBrickY);
  const int32_t cells_z = std::min(kBrickZ, extent.nz - brick.bz * kBrickZ);
  const uint64_t row = (uint64_t{1} << cells_x) - 1;
  uint64_t word = 0;
  for (int32_t j = 0; j < cells_y; ++j) word |= row << (16 * j);
  BrickBits mask;
  for (int32_t k = 0; k < cells_z; ++k) mask.words[static_cast<size_t>(k)] = word;
  return mask;
}

bool InsideExtent(const LatticeExtent& extent, BrickCoordinates brick) {
  return brick.bx >= 0 && brick.by >= 0 && brick.bz >= 0 &&
         brick.bx * int64_t{kBrickX} < extent.nx && brick.by * int64_t{kBrickY} < extent.ny &&
         brick.bz * int64_t{kBrickZ} < extent.nz;
}

absl::Status CheckBrick(const LatticeExtent& extent, BrickKey key, const BrickBits& bits) {
  const BrickCoordinates brick = key.coordinates();
  if (!InsideExtent(extent, brick)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("brick (%d, %d, %d) lies outside the extent of %d x %d x %d cells",
                        brick.bx, brick.by, brick.bz, extent.nx, extent.ny, extent.nz));
  }
  if (!(bits & ~InsideMask(extent, brick)).Empty()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("brick (%d, %d, %d) has points outside the extent of %d x %d x %d cells",
                        brick.bx, brick.by, brick.bz, extent.nx, extent.ny, extent.nz));
  }
  return absl::OkStatus();
}

// Lattice distances are those in the world only if the axes have length 1 and are perpendicular.
// Numbers in headers are rounded, hence the margin.
absl::Status CheckDirection(const std::array<double, 9>& direction) {
  constexpr double kMargin = 1e-3;
  for (size_t a = 0; a < 3; ++a) {
    for (size_t b = a; b < 3; ++b) {
      double product = 0;
      for (size_t row = 0; row < 3; ++row)
        product += direction[3 * row + a] * direction[3 * row + b];
      const double wanted = a == b ? 1 : 0;
      if (std::abs(product - wanted) <= 2 * kMargin) continue;
      return absl::InvalidArgumentError(
          a == b ? absl::StrFormat("direction: axis %d has the length %g, it must be 1 within %g; "
                                   "put the scale into the spacing",
                                   a, std::sqrt(product), kMargin)
                 : absl::StrFormat("direction: axes %d and %d are not perpendicular, the cosine "
                                   "between them is %g; resample without shear",
                                   a, b, product));
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckGrid(const LatticeExtent& extent, const Placement& placement) {
  for (int32_t cells : {extent.nx, extent.ny, extent.nz}) {
    if (cells < 1 || cells > kMaxExtentCells) {
      return absl::InvalidArgumentError(
          absl::StrFormat("extent of %d x %d x %d cells: each axis must have 1 to %d", extent.nx,
                          extent.ny, extent.nz, kMaxExtentCells));
    }
  }
  return CheckPlacement(placement);
}

absl::Status CheckPlacement(const Placement& placement) {
  for (double spacing : placement.spacing) {
    if (!(spacing > 0) || !std::isfinite(spacing)) {
      return absl::InvalidArgumentError(
          absl::StrFormat("spacing %g: must be finite and positive", spacing));
    }
  }
  const auto finite = [](double v) { return std::isfinite(v); };
  if (!std::ranges::all_of(placement.origin, finite) ||
      !std::ranges::all_of(placement.direction, finite)) {
    return absl::InvalidArgumentError("origin and direction must be finite");
  }
  return CheckDirection(placement.direction);
}

absl::StatusOr<Volume> Volume::Create(LatticeExtent extent, const Placement& placement,
                                      std::vector<BrickKey> keys, std::vector<BrickBits> bricks) {
  BCCSKEL_RETURN_IF_ERROR(CheckGrid(extent, placement));
  if (keys.size() != bricks.size()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%d brick keys for %d bricks", keys.size(), bricks.size()));
  }
  for (size_t n = 0; n < keys.size(); ++n) {
    BCCSKEL_RETURN_IF_ERROR(CheckBrick(extent, keys[n], bricks[n]));
  }
  if (!std::ranges::is_sorted(keys)) {
    std::vector<size_t> order(keys.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::ranges::sort(order, {}, [&](size_t n) { return keys[n]; });
    std::vector<BrickKey> sorted_keys(keys.size());
    std::vector<BrickBits> sorted_bricks(keys.size());
    for (size_t n = 0; n < order.size(); ++n) {
      sorted_keys[n] = keys[order[n]];
      sorted_bricks[n] = bricks[order[n]];
    }
    keys = std::move(sorted_keys);
    bricks = std::move(sorted_bricks);
  }
  if (auto twice = std::ranges::adjacent_find(keys); twice != keys.end()) {
    const BrickCoordinates brick = twice->coordinates();
    return absl::InvalidArgumentError(
        absl::StrFormat("brick (%d, %d, %d) is given twice", brick.bx, brick.by, brick.bz));
  }
  return FromSortedBricks(extent, placement, std::move(keys), std::move(bricks));
}

Volume Volume::FromSortedBricks(LatticeExtent extent, const Placement& placement,
                                std::vector<BrickKey> keys, std::vector<BrickBits> bricks) {
  size_t kept = 0;
  for (size_t n = 0; n < keys.size(); ++n) {
    if (bricks[n].Empty()) continue;
    keys[kept] = keys[n];
    bricks[kept] = bricks[n];
    ++kept;
  }
  keys.resize(kept);
  bricks.resize(kept);
  bricks.emplace_back();
  Volume volume;
  volume.extent_ = extent;
  volume.placement_ = placement;
  volume.keys_ = std::move(keys);
  volume.bricks_ = std::move(bricks);
  return volume;
}

std::optional<BrickIndex> Volume::Find(BrickKey key) const {
  if (keys_.empty()) return std::nullopt;
  // A branchless binary search.
  const BrickKey* first = keys_.data();
  for (size_t count = keys_.size(); count > 1;) {
    const size_t half = count / 2;
    first += first[half] <= key ? half : 0;
    count -= half;
  }
  if (*first != key) return std::nullopt;
  return static_cast<BrickIndex>(first - keys_.data());
}

bool Volume::Contains(LatticePoint p) const {
  if (!IsOnLattice(p) || !extent_.Contains(p)) return false;
  const BrickAddress address = AddressOf(p);
  const std::optional<BrickIndex> index = Find(BrickKey(address.brick));
  return index && bricks_[*index].Test(address.bit);
}

uint64_t Volume::PointCount() const { return CountPoints(bricks()); }

std::vector<LatticePoint> Volume::SortedPoints() const {
  std::vector<LatticePoint> points;
  ForEachPoint([&](LatticePoint p) { points.push_back(p); });
  std::ranges::sort(points);
  return points;
}

BrickBits& VolumeBuilder::Brick(BrickKey key) {
  const auto [it, inserted] = index_.try_emplace(key.value(), keys_.size());
  if (inserted) {
    keys_.push_back(key);
    bricks_.emplace_back();
  }
  return bricks_[it->second];
}

void VolumeBuilder::Add(LatticePoint p) {
  if (!IsOnLattice(p) || !extent_.Contains(p)) return;
  const BrickAddress address = AddressOf(p);
  Brick(BrickKey(address.brick)).Set(address.bit);
}

void VolumeBuilder::Remove(LatticePoint p) {
  if (!IsOnLattice(p) || !extent_.Contains(p)) return;
  const BrickAddress address = AddressOf(p);
  Brick(BrickKey(address.brick)).Clear(address.bit);
}

absl::StatusOr<Volume> VolumeBuilder::Build() && {
  return Volume::Create(extent_, placement_, std::move(keys_), std::move(bricks_));
}

Volume VolumeOfPoints(std::span<const LatticePoint> points) {
  LatticeExtent extent = {1, 1, 1};
  for (LatticePoint p : points) {
    extent.nx = std::max(extent.nx, p.x / 2 + 1);
    extent.ny = std::max(extent.ny, p.y / 2 + 1);
    extent.nz = std::max(extent.nz, p.z / 2 + 1);
  }
  VolumeBuilder builder(extent);
  for (LatticePoint p : points) builder.Add(p);
  return *std::move(builder).Build();
}

}  // namespace bccskel
