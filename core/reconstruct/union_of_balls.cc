#include "core/reconstruct/union_of_balls.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bccskel {
namespace {

// Radii come from distances to the nearest background point, which must stay outside however the
// last digit was rounded.
constexpr double kRounding = 1e-6;

struct Range {
  int32_t low;
  int32_t high;
};
// The integers nearer to `center` than `reach`, within 0..size - 1.
Range IntegersWithin(double center, double reach, int32_t size) {
  return {static_cast<int32_t>(
              std::ceil(std::clamp(center - reach, 0.0, static_cast<double>(size) + 1))),
          static_cast<int32_t>(std::floor(std::clamp(center + reach, -1.0, size - 1.0)))};
}

class Filler {
 public:
  Filler(const LatticeExtent& extent, const Placement& placement)
      : extent_(extent), builder_(extent, placement) {}

  void Add(const OpenBall& ball) {
    const double reach = ball.radius * (1 - kRounding);
    const Range layers = IntegersWithin(ball.center[2], reach, 2 * extent_.nz);
    for (int32_t z = layers.low; z <= layers.high; ++z) {
      const double dz = z - ball.center[2];
      const double flat = std::sqrt(std::max(0.0, reach * reach - dz * dz));
      const Range rows = IntegersWithin(ball.center[1], flat, 2 * extent_.ny);
      for (int32_t y = rows.low + ((rows.low ^ z) & 1); y <= rows.high; y += 2) {
        const double dy = y - ball.center[1];
        AddRow(y, z,
               IntegersWithin(ball.center[0], std::sqrt(std::max(0.0, flat * flat - dy * dy)),
                              2 * extent_.nx));
      }
    }
  }

  absl::StatusOr<Volume> Build() && { return std::move(builder_).Build(); }

 private:
  // The points of a row, brick by brick.
  void AddRow(int32_t y, int32_t z, const Range& columns) {
    int32_t x = columns.low + ((columns.low ^ z) & 1);
    while (x <= columns.high) {
      BrickAddress address = AddressOf({x, y, z});
      BrickBits& brick = builder_.Brick(BrickKey(address.brick));
      do {
        brick.Set(address.bit++);
        x += 2;
      } while (x <= columns.high && (address.bit & 15) != 0);
    }
  }

  LatticeExtent extent_;
  VolumeBuilder builder_;
};

}  // namespace

std::array<double, 3> LatticePlaceOf(const WorldPoint& p, const Placement& placement) {
  const std::array<double, 9>& m = placement.direction;
  const auto minor = [&](size_t a, size_t b, size_t c, size_t d) {
    return m[a] * m[d] - m[b] * m[c];
  };
  const std::array<double, 9> adjugate = {minor(4, 5, 7, 8), minor(2, 1, 8, 7), minor(1, 2, 4, 5),
                                          minor(5, 3, 8, 6), minor(0, 2, 6, 8), minor(2, 0, 5, 3),
                                          minor(3, 4, 6, 7), minor(1, 0, 7, 6), minor(0, 1, 3, 4)};
  const double determinant = m[0] * adjugate[0] + m[1] * adjugate[3] + m[2] * adjugate[6];
  std::array<double, 3> place;
  for (size_t axis = 0; axis < 3; ++axis) {
    double sum = 0;
    for (size_t n = 0; n < 3; ++n) sum += adjugate[3 * axis + n] * (p[n] - placement.origin[n]);
    place[axis] = 2 * sum / (determinant * placement.spacing[axis]);
  }
  return place;
}

absl::StatusOr<Volume> UnionOfBalls(std::span<const OpenBall> balls, const LatticeExtent& extent,
                                    const Placement& placement, const exec::Context& context) {
  Filler filler(extent, placement);
  for (const OpenBall& ball : balls) {
    if (context.ShouldStop()) return context.StopStatus();
    filler.Add(ball);
  }
  return std::move(filler).Build();
}

}  // namespace bccskel
