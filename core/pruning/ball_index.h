#ifndef BCCSKEL_CORE_PRUNING_BALL_INDEX_H_
#define BCCSKEL_CORE_PRUNING_BALL_INDEX_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/distance/places.h"
#include "core/exec/context.h"
#include "core/pruning/point_table.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Finds out whether a point of one branch lies in the ball of another branch.
// Does:  groups all curve points by the smallest power of two above their radius. Each group is
//        stored in cubes twice as wide as that power, so the center of a ball that contains a point
//        lies in one of 8 cubes.
// Cost:  a query visits the points of a few cubes per power of two.
// Threads: one thread per instance. Copies share what they index, so each worker has one.
class BallIndex {
 public:
  // Indexes the points that `set` contains now, with their radii. Points may be removed from the
  // set later. The index is incomplete if the context requests a stop.
  explicit BallIndex(const ThinSet& set, const exec::Context& context = {});

  // Selects the branch that the following IsCovered() calls are about.
  void SetOwn(std::span<const LatticePoint> own);

  // Whether p lies within 0.9 of the radius of a point of `set` that is not on p's own branch.
  // `radius`: the distance from p to the background, or more. `distance_to_junction`: from p.
  // Points whose radius is half of that or more do not count, since branches that meet are always
  // close to each other there.
  bool IsCovered(LatticePoint p, double radius, double distance_to_junction,
                 const ThinSet& set) const;

 private:
  static constexpr size_t kLevels = 32;
  struct Ball {
    LatticePoint center;
    float radius;
  };
  struct Cube {
    uint32_t first = 0;  // index of its first ball
    uint32_t end = 0;
  };

  static LatticePoint CubeOf(const Coordinates& place, size_t level);

  struct Cubes {
    std::vector<Ball> balls;  // cube by cube
    std::vector<Cube> cubes;
    std::array<PointTable<uint32_t>, kLevels> levels;  // index of each cube
  };

  AxisScale scale_;
  std::shared_ptr<const Cubes> shared_;
  PointTable<char> own_;  // the points of the branch selected by SetOwn()
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_BALL_INDEX_H_
