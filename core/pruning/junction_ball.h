#ifndef BCCSKEL_CORE_PRUNING_JUNCTION_BALL_H_
#define BCCSKEL_CORE_PRUNING_JUNCTION_BALL_H_

#include <cstddef>
#include <span>
#include <vector>

#include "core/pruning/branch_walk.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// The part of a skeleton around a junction, up to the exits: the points where it leaves the
// junction's ball. Near the center all branches are as thick as the ball, so exits lie at 0.8 of
// its radius, where branches can be compared.
class JunctionBall {
 public:
  static constexpr double kExit = 0.8;

  struct Visited {
    LatticePoint p;
    size_t before = 0;  // index of the point before it on the way from the center
  };

  // `without`: the points of a branch that is left out, the one beside the center last. `radii`:
  // distance of the exits, in radii of the ball.
  JunctionBall(const ThinSet& set, LatticePoint center, std::span<const LatticePoint> without = {},
               double radii = kExit);

  // From the center, which is the first, to the exits.
  std::span<const Visited> visited() const { return visited_; }
  // Indices of the first points outside, and of ends inside. None if the ball is full of points.
  std::span<const size_t> exits() const { return exits_; }
  // Of the exits, that with the largest radius: where the body lies. Needs: there is an exit.
  size_t body() const { return body_; }
  double radius() const { return radius_; }
  // Distance of the exits from the center.
  double reach() const { return reach_; }
  // The largest radius of the exits that do not lead toward the body; 0 if there is none.
  double ThickestLimb(const ThinSet& set) const;
  // The points from the center to a visited one.
  std::vector<LatticePoint> WayTo(size_t visited) const;

 private:
  const double radius_, reach_;
  std::vector<Visited> visited_;
  std::vector<size_t> exits_;
  size_t body_ = 0;
};

// Whether a branch is an end of the body itself, beyond thinner limbs, such as a snout beyond two
// ears: except for the body, no other branch that leaves the ball at the junction is as thick.
// `may_end_inside`: whether it may end within the ball; its end is compared then.
// Needs: the branch has a junction.
bool IsBodyEnd(const ThinSet& set, const FreeBranch& branch, bool may_end_inside);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_JUNCTION_BALL_H_
