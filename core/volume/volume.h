#ifndef BCCSKEL_CORE_VOLUME_VOLUME_H_
#define BCCSKEL_CORE_VOLUME_VOLUME_H_

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/lattice/lattice_point.h"
#include "core/volume/brick.h"
#include "core/volume/brick_neighbors.h"

namespace bccskel {

// A bcc object: the set O of section 2, stored as the bricks that hold at least one point. Empty
// space costs nothing, in memory or in time. The representation is canonical: equal point sets
// with equal extents have equal bricks.
class Volume {
 public:
  Volume() : bricks_(1) {}

  // Takes bricks in any order and drops the empty ones.
  // Errors: INVALID_ARGUMENT for a bad extent or spacing, a duplicate brick, a brick outside the
  //         extent, or a set bit outside it; the message names the value and the limit.
  static absl::StatusOr<Volume> Create(LatticeExtent extent, const Placement& placement,
                                       std::vector<BrickKey> keys, std::vector<BrickBits> bricks);

  // Like Create() for bricks known to be valid: strictly increasing keys, all inside the extent.
  // Empty bricks are dropped.
  static Volume FromSortedBricks(LatticeExtent extent, const Placement& placement,
                                 std::vector<BrickKey> keys, std::vector<BrickBits> bricks);

  const LatticeExtent& extent() const { return extent_; }
  const Placement& placement() const { return placement_; }

  size_t brick_count() const { return keys_.size(); }
  bool empty() const { return keys_.empty(); }
  std::span<const BrickKey> keys() const { return keys_; }  // strictly increasing
  // bricks()[n] belongs to keys()[n].
  std::span<const BrickBits> bricks() const { return {bricks_.data(), keys_.size()}; }
  // The same with a padding brick at the end, which is empty and stands for every brick that is not
  // stored.
  std::span<const BrickBits> padded_bricks() const { return bricks_; }
  // neighbors()[n] are the bricks around keys()[n]. Computed on first use and kept, since every
  // stage needs them.
  std::span<const BrickNeighborhood> neighbors() const { return neighbors_.Of(keys_); }

  // The box in which the object is known; none: everywhere. Distances take no point outside it for
  // background. Needs: in stored bricks, the points outside the window are set.
  const std::optional<LatticeBox>& window() const { return window_; }
  void SetWindow(const std::optional<LatticeBox>& window) { window_ = window; }
  // Whether all of the brick lies outside the window. Bricks with negative coordinates cannot be
  // stored. Along an axis on which the window does not end they are all background, and their
  // points outside the window are no nearer to points inside than others.
  bool IsUnknown(const BrickCoordinates& brick) const {
    return window_.has_value() && !IsBefore(brick) && !window_->Meets(BoxOf(brick));
  }
  // Whether some of the brick lies outside the window.
  bool IsPartlyUnknown(const BrickCoordinates& brick) const {
    return window_.has_value() && !IsBefore(brick) && !window_->Contains(BoxOf(brick));
  }

  std::optional<BrickIndex> Find(BrickKey key) const;
  // False for points off the lattice or outside the extent.
  bool Contains(LatticePoint p) const;
  uint64_t PointCount() const;

  // Calls visit(LatticePoint) for every point, in brick order.
  template <typename Visit>
  void ForEachPoint(Visit visit) const {
    for (size_t n = 0; n < keys_.size(); ++n) {
      const BrickCoordinates brick = keys_[n].coordinates();
      bricks_[n].ForEachSetBit([&](int bit) { visit(PointOf(brick, bit)); });
    }
  }
  // All points in lattice order (z, then y, then x).
  std::vector<LatticePoint> SortedPoints() const;

  friend bool operator==(const Volume&, const Volume&) = default;

 private:
  // Whether the brick has a negative coordinate along an axis on which the window does not end.
  bool IsBefore(const BrickCoordinates& brick) const {
    const LatticePoint& low = window_->low;
    const auto ends_before = [](int32_t b, int32_t from) { return b < 0 && from >= 0; };
    if (ends_before(brick.bx, low.x) || ends_before(brick.by, low.y) ||
        ends_before(brick.bz, low.z))
      return false;
    return std::min({brick.bx, brick.by, brick.bz}) < 0;
  }

  LatticeExtent extent_;
  Placement placement_;
  std::optional<LatticeBox> window_;
  std::vector<BrickKey> keys_;
  std::vector<BrickBits> bricks_;  // keys_.size() + 1, the last one empty
  LazyBrickNeighbors neighbors_;
};

// OK when all numbers are finite, spacings positive, and the axes of length 1 and perpendicular.
absl::Status CheckPlacement(const Placement& placement);
// The same, and each axis has 1..kMaxExtentCells cells.
absl::Status CheckGrid(const LatticeExtent& extent, const Placement& placement);

// Collects points and words in any order.
class VolumeBuilder {
 public:
  explicit VolumeBuilder(LatticeExtent extent, const Placement& placement = {})
      : extent_(extent), placement_(placement) {}

  // Points off the lattice or outside the extent are ignored.
  void Add(LatticePoint p);
  void Remove(LatticePoint p);
  // The brick, created empty on first use. The reference lives until the next call.
  BrickBits& Brick(BrickKey key);

  // Errors: as Volume::Create().
  absl::StatusOr<Volume> Build() &&;

 private:
  LatticeExtent extent_;
  Placement placement_;
  std::unordered_map<uint64_t, size_t> index_;
  std::vector<BrickKey> keys_;
  std::vector<BrickBits> bricks_;
};

// A volume just large enough for the points, each coordinate >= 0.
Volume VolumeOfPoints(std::span<const LatticePoint> points);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_VOLUME_VOLUME_H_
