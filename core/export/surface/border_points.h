#ifndef BCCSKEL_CORE_EXPORT_SURFACE_BORDER_POINTS_H_
#define BCCSKEL_CORE_EXPORT_SURFACE_BORDER_POINTS_H_

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/lattice/directions.h"
#include "core/volume/volume.h"

namespace bccskel {

// An object point with a background neighbor, and which of its neighbors are background.
struct BorderPoint {
  LatticePoint point;
  NeighborMask background = 0;
  uint64_t first_vertex = 0;  // of its steps to the background, numbered in bit order
};

// All border points of an object, in brick order, and the numbers of the steps that leave it.
class BorderPoints {
 public:
  // Needs: the object outlives this. Errors: CANCELLED, DEADLINE_EXCEEDED.
  static absl::StatusOr<BorderPoints> Find(const Volume& object, const exec::Context& context);

  const std::vector<BorderPoint>& points() const { return points_; }
  uint64_t vertex_count() const { return vertex_count_; }

  // Needs: an object point with a background neighbor.
  const BorderPoint& At(LatticePoint p) const;
  // The number of the step from a border point to its background neighbor at d.
  static uint64_t VertexOf(const BorderPoint& from, Direction d) {
    const auto before = static_cast<unsigned>(from.background & (d.mask() - 1));
    return from.first_vertex + static_cast<uint64_t>(std::popcount(before));
  }

 private:
  explicit BorderPoints(const Volume& object) : object_(&object) {}
  void AddBrick(BrickIndex brick);

  const Volume* object_;
  std::vector<BorderPoint> points_;
  std::vector<BrickBits> border_;       // by brick
  std::vector<size_t> first_of_brick_;  // positions in points_
  uint64_t vertex_count_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_EXPORT_SURFACE_BORDER_POINTS_H_
