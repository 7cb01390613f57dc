#ifndef BCCSKEL_CORE_DISTANCE_NEAREST_BACKGROUND_H_
#define BCCSKEL_CORE_DISTANCE_NEAREST_BACKGROUND_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/distance/border_bricks.h"
#include "core/lattice/lattice_point.h"
#include "core/volume/brick.h"

namespace bccskel {

// Squared lengths of n lattice coordinates along an axis, as floats. Each is stored `kCopies` times
// in a row, and those of one parity of n are contiguous.
template <size_t kCopies>
class SquaredWays {
 public:
  explicit SquaredWays(double unit) : unit_(unit) {}

  // The squares of n, n + 2, n + 4, ... Needs: Reach() for all of them.
  const float* From(int32_t n) const {
    return squares_[n & 1].data() + (n >> 1) * static_cast<ptrdiff_t>(kCopies) + middle_;
  }
  // Computes the squares of -most to most.
  void Reach(int32_t most) {
    if (most <= most_) return;
    most_ = 2 * most;
    for (int32_t odd : {0, 1}) {
      std::vector<float>& squares = squares_[static_cast<size_t>(odd)];
      squares.clear();
      for (int32_t n = odd - most_; n <= most_; n += 2) {
        const double length = unit_ * n;
        squares.insert(squares.end(), kCopies, static_cast<float>(length * length));
      }
    }
    middle_ = static_cast<ptrdiff_t>(kCopies) * (most_ / 2);
  }

 private:
  double unit_;
  int32_t most_ = -1;
  ptrdiff_t middle_ = 0;
  std::array<std::vector<float>, 2> squares_;  // by parity
};

// A box that may hold a point nearer than a given distance.
struct NearBox {
  uint32_t box = 0;
  float squared = 0;  // lower bound of the squared distance to any point of the box
};

// The point from which a search starts.
struct PointSearch {
  LatticePoint at;
  std::array<float, 3> squares = {1, 1, 1};  // of a lattice coordinate along each axis
  // Cover the width of the object.
  const SquaredWays<1>& y;
  const SquaredWays<kBrickY>& z;
};

// The nearest background point so far, and the square of its distance.
struct NearestPoint {
  LatticePoint at;
  float squared = 0;
};

// Finds the boxes of the first level that may hold something nearer than `below` (squared), in
// order. Levels as BorderBricks::groups(); only boxes inside near ones of the level above are
// visited.
// Shapes: `found` has room for all boxes of the first level. Returns: how many were found.
size_t FindNearBoxes(std::span<const Boxes> levels, const PointSearch& search, float below,
                     NearBox* found);

// Searches a group of bricks for a nearer background point. The square of a distance is x * x *
// squares[0] + y + z, added in this order and rounded after each step. `places` and `boxes` belong
// together.
void FindNearestBackground(std::span<const BorderBricks::Place> places, const Boxes& boxes,
                           size_t group, std::span<const BrickBits> object,
                           const PointSearch& search, NearestPoint& nearest);

// The nearest background point of a brick.
struct NearestInPlace {
  NearestPoint nearest;
  size_t place = 0;
};

// Finds the bricks of a group, in order, that have the nearest background points, if these are
// nearer than `below`, and possibly some others. Lowers `below` to slightly more than their squared
// distance.
// Shapes: `found` has room for a group. Returns: how many were found.
size_t FindAllNearest(std::span<const BorderBricks::Place> places, const Boxes& boxes, size_t group,
                      std::span<const BrickBits> object, const PointSearch& search, float& below,
                      NearestInPlace* found);

// The same for bricks without boxes. Shapes: `found` has room for all places.
size_t FindAllNearest(std::span<const BorderBricks::Place> places,
                      std::span<const BrickBits> object, const PointSearch& search, float below,
                      NearestInPlace* found);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_NEAREST_BACKGROUND_H_
