#include "core/export/reconstruct/union_of_balls.h"

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
      : extent_(extent), spacing_(placement.spacing), builder_(extent, placement) {}

  void Add(const OpenBall& ball) {
    const double reach = ball.radius * (1 - kRounding);
    const auto [cx, cy, cz] = ball.center;
    const Range layers = Within(cz, reach, 2, 2 * extent_.nz);
    for (int32_t z = layers.low; z <= layers.high; ++z) {
      const double flat = Leg(reach, z - cz, 2);
      const Range rows = Within(cy, flat, 1, 2 * extent_.ny);
      for (int32_t y = rows.low + ((rows.low ^ z) & 1); y <= rows.high; y += 2) {
        AddRow(y, z, Within(cx, Leg(flat, y - cy, 1), 0, 2 * extent_.nx));
      }
    }
  }

  absl::StatusOr<Volume> Build() && { return std::move(builder_).Build(); }

 private:
  // A lattice unit in the world.
  double UnitAlong(size_t axis) const { return spacing_[axis] / 2; }
  Range Within(double center, double reach, size_t axis, int32_t size) const {
    return IntegersWithin(center, reach / UnitAlong(axis), size);
  }
  // The radius of a ball's section, `off` lattice units from its center along an axis.
  double Leg(double reach, double off, size_t axis) const {
    const double leg = off * UnitAlong(axis);
    return std::sqrt(std::max(0.0, reach * reach - leg * leg));
  }
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
  std::array<double, 3> spacing_;
  VolumeBuilder builder_;
};

}  // namespace

std::vector<OpenBall> BallsOf(const SkeletonGraph& graph) {
  std::vector<OpenBall> balls;
  balls.reserve(graph.nodes.size() + graph.points.size() + graph.sheets.size());
  const auto add = [&](const SkeletonPoint& p) {
    const auto [x, y, z] = p.point;
    balls.push_back({{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)},
                     graph.RadiusOf(p)});
  };
  for (const SkeletonNode& node : graph.nodes) add(node.at);
  std::ranges::for_each(graph.points, add);
  std::ranges::for_each(graph.sheets, add);
  return balls;
}

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
