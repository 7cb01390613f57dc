#ifndef BCCSKEL_CORE_PRUNING_BALL_GAPS_H_
#define BCCSKEL_CORE_PRUNING_BALL_GAPS_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/distance/places.h"
#include "core/exec/stop_poll.h"
#include "core/pruning/point_table.h"
#include "core/pruning/thin_set.h"
#include "core/volume/volume.h"

namespace bccskel {

// Where the object lies outside the balls of its curves.
// Does:  divides the object into cubes. Each gets the ball that reaches nearest to its middle, of
//        those of the curve points in it and of the balls of the cubes beside it, until nothing
//        changes. So a limb across a gap has no influence.
// Cost:  a few visits of each cube; 32 bytes and a table entry each.
class BallGaps {
 public:
  struct Ball {
    LatticePoint center;
    float radius = 0;

    friend bool operator==(const Ball&, const Ball&) = default;
  };
  struct Peak {
    LatticePoint tip;  // a point of the object
    Ball ball;         // the one nearest to it
    double gap = 0;    // from the ball to the tip, lattice units
  };

  // `edge` of the cubes, in lattice units: a power of two, at least 8. Incomplete if `poll` stops.
  BallGaps(const Volume& object, const ThinSet& set, int32_t edge, StopPoll& poll);

  // The points farthest outside all balls, in cubes that are farther outside than the 26 around
  // them, where the nearest ball has at least this radius. `least_gap`: in its radii.
  std::vector<Peak> Peaks(double least_radius, double least_gap, StopPoll& poll) const;

 private:
  static constexpr float kFar = std::numeric_limits<float>::infinity();
  struct Cube {
    LatticePoint at;  // in cubes
    Ball ball;
    float gap = kFar;  // from the ball to the middle
  };

  void FindCubes(const Volume& object);
  LatticePoint CubeOf(LatticePoint p) const { return {p.x >> bits_, p.y >> bits_, p.z >> bits_}; }
  // Returns whether the ball is nearer to the middle of the cube than the one before.
  bool Offer(uint32_t cube, const Ball& ball);
  void Spread(StopPoll& poll);
  bool IsPeak(uint32_t cube) const;
  // Calls visit(cube) for those of the 27 cubes that hold points of the object, until it returns
  // true. Returns whether it did.
  template <typename Visit>
  bool AnyAround(uint32_t cube, Visit visit) const;
  double GapAt(LatticePoint p, const std::vector<Ball>& balls, Ball& nearest) const;
  Peak PeakIn(uint32_t cube, const std::vector<Ball>& balls, NearbyBricks& bricks) const;

  const Volume& object_;
  const AxisScale scale_;
  const int bits_;
  PointTable<uint32_t> index_;
  std::vector<Cube> cubes_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_BALL_GAPS_H_
