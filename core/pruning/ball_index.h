#ifndef BCCSKEL_CORE_PRUNING_BALL_INDEX_H_
#define BCCSKEL_CORE_PRUNING_BALL_INDEX_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/distance/places.h"
#include "core/exec/context.h"
#include "core/pruning/point_table.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Tells whether a point of a branch lies in the ball of another branch.
// Does:  keeps the points of all curves by the power of two above their radius, in cubes twice as
//        wide as that power: a ball that holds a point has its center in one of 8 cubes.
// Cost:  a search visits the points of a few cubes for each power.
// Threads: one thread per instance.
class BallIndex {
 public:
  // The points that `set` has now, with their radii. Points may go from the set later. Left
  // unfinished where the context says to stop.
  BallIndex(const ThinSet& set, const AxisScale& scale, const exec::Context& context = {});

  // The branch that IsCovered() is asked about from now on.
  void SetOwn(std::span<const LatticePoint> own);

  // Whether p lies within 0.9 of the radius of a point of `set` that is not one of its own branch.
  // `way` leads from p to the branch's junction: points with a radius of half of that and more do
  // not count, since branches that meet are always near each other.
  bool IsCovered(LatticePoint p, double way, const ThinSet& set) const;

 private:
  static constexpr size_t kLevels = 32;
  struct Ball {
    LatticePoint center;
    float radius;
    uint32_t branch = 0;  // the last that it was an own one of
  };
  struct Cube {
    uint32_t first = 0;  // of its balls
    uint32_t end = 0;
  };

  static LatticePoint CubeOf(const Coordinates& place, size_t level);

  AxisScale scale_;
  std::vector<Ball> balls_;  // cube by cube
  std::vector<Cube> cubes_;
  std::array<PointTable<uint32_t>, kLevels> levels_;  // the number of each cube
  PointTable<uint32_t> ball_at_;
  uint32_t branch_ = 1;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_BALL_INDEX_H_
