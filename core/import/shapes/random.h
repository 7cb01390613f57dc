#ifndef BCCSKEL_CORE_IMPORT_SHAPES_RANDOM_H_
#define BCCSKEL_CORE_IMPORT_SHAPES_RANDOM_H_

#include <cstdint>
#include <random>

#include "core/import/shapes/solids.h"

namespace bccskel::shapes {

// The standard fixes this engine's numbers, but not those of its library's distributions.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}

  double Between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  // Uniform in the ball of radius 1 around the origin.
  Vector InUnitBall() {
    while (true) {
      const double x = Between(-1, 1), y = Between(-1, 1), z = Between(-1, 1);
      const Vector v = {x, y, z};
      if (Dot(v, v) <= 1) return v;
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace bccskel::shapes

#endif  // BCCSKEL_CORE_IMPORT_SHAPES_RANDOM_H_
