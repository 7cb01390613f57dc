#include "core/prepare/ball_closing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "core/certificate/neighbor_planes.h"
#include "core/distance/chamfer_weights.h"
#include "core/distance/distance_field.h"
#include "core/distance/places.h"
#include "core/exec/status_macros.h"
#include "core/exec/stop_poll.h"
#include "core/prepare/brick_sets.h"

namespace bccskel {
namespace {

// Memory per brick around the object: a distance field while it is computed, and bits.
constexpr uint64_t kBytesPerRoomBrick = 5120;
// A ball of at most this radius is compared with the object point by point: distance fields take up
// to five times as long.
constexpr double kFewPoints = 5;
// So is a larger ball if it has at most this many points per brick of the distance fields: the
// bricks around dust are many times those that contain it.
constexpr double kVisitsPerBrick = 32;

// Rounded as in distance fields.
double RoundedLength(LatticePoint way, const AxisScale& scale) {
  const auto square = [](double length) { return static_cast<float>(length * length); };
  const auto x = static_cast<float>(std::abs(way.x));
  const float squared =
      x * x * square(scale[0]) + square(scale[1] * way.y) + square(scale[2] * way.z);
  return std::sqrt(static_cast<double>(squared));
}

// The offsets from the center of the ball to its other points, the farthest first: most points near
// an object have background there.
std::vector<LatticePoint> WaysInBall(double radius, const AxisScale& scale) {
  std::vector<std::pair<double, LatticePoint>> ways;
  const auto reach = static_cast<int32_t>(radius);
  const bool few = radius <= kFewPoints;
  for (int32_t z = -reach; z <= reach; ++z) {
    for (int32_t y = -reach; y <= reach; ++y) {
      for (int32_t x = -reach; x <= reach; ++x) {
        const double length = few ? std::hypot(scale[0] * x, scale[1] * y, scale[2] * z)
                                  : RoundedLength({x, y, z}, scale);
        if (IsOnLattice({x, y, z}) && length > 0 && length < radius) {
          ways.push_back({length, {x, y, z}});
        }
      }
    }
  }
  std::ranges::sort(ways, std::greater());
  std::vector<LatticePoint> sorted;
  for (const auto& [length, way] : ways) sorted.push_back(way);
  return sorted;
}

// Visits the points with adjacent background.
template <typename Visit>
void ForEachSurfacePoint(const Volume& object, Visit visit) {
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    const BrickBits surface = BorderOf(object.bricks()[n], NeighborPlanesOf(object, n));
    const BrickCoordinates at = object.keys()[n].coordinates();
    surface.ForEachSetBit([&](int bit) { visit(PointOf(at, bit)); });
  }
}

template <typename Passes>
Volume PointsAt(const Volume& volume, const DistanceField& distance, Passes passes) {
  std::vector<BrickBits> bricks(volume.brick_count());
  for (BrickIndex n = 0; n < bricks.size(); ++n) {
    volume.bricks()[n].ForEachSetBit([&](int bit) {
      if (passes(distance.ToLatticeUnits(distance.At(n, bit)))) bricks[n].Set(bit);
    });
  }
  return Volume::FromSortedBricks(volume.extent(), volume.placement(),
                                  {volume.keys().begin(), volume.keys().end()}, std::move(bricks));
}

// How a ball is compared with the object, and how far around it bricks are visited.
struct Closing {
  bool by_points = false;
  BrickCoordinates room;
};

// Bricks that are not visited count as background. That is wrong by up to two radii from there, and
// affects the closing up to two radii from the object.
Closing ClosingOf(const Volume& object, double radius) {
  const BrickCoordinates room = RoomFor(4 * radius);
  const AxisScale scale = AxisScaleOf(object.placement());
  constexpr double kPointsPerUnit = 0.25, kBall = 4 * std::numbers::pi / 3;
  const double ball =
      kPointsPerUnit * kBall * radius * radius * radius / (scale[0] * scale[1] * scale[2]);
  const double visits = ball * static_cast<double>(object.PointCount());
  const bool is_dust =
      visits <= kVisitsPerBrick * static_cast<double>(MostBricksAround(object, room));
  if (radius <= kFewPoints || is_dust) return {true, RoomFor(radius)};
  return {false, room};
}

// Reserves memory for the bricks to visit and lists them.
absl::StatusOr<std::vector<BrickKey>> BricksToLookAt(const Volume& object, BrickCoordinates room,
                                                     exec::MemoryBudget& memory) {
  BCCSKEL_RETURN_IF_ERROR(memory.TakeFor(MostBricksAround(object, room), kBytesPerListedBrick,
                                         "bricks to list around the object"));
  std::vector<BrickKey> keys = BricksAround(object, room);
  BCCSKEL_RETURN_IF_ERROR(
      memory.TakeFor(keys.size(), kBytesPerRoomBrick, "bricks to look for tunnels in"));
  return keys;
}

Volume WithRoomAround(const Volume& object, BrickCoordinates room) {
  return ShiftedBy(object, room, 1, WithRoom(object.extent(), room));
}

absl::StatusOr<Volume> ClosedByDistances(const Volume& object, const Volume& bricks, double radius,
                                         const exec::Context& context) {
  const Volume around = Difference(bricks, object);
  BCCSKEL_ASSIGN_OR_RETURN(const DistanceField distance,
                           ComputeDistance(around, DistanceKind::kEuclidean, context));
  const Volume near = PointsAt(around, distance, [&](double far) { return far < radius; });
  const Volume grown = Union(object, near);
  BCCSKEL_ASSIGN_OR_RETURN(const DistanceField depth,
                           ComputeDistance(grown, DistanceKind::kEuclidean, context));
  return PointsAt(grown, depth, [&](double deep) { return deep >= radius; });
}

// Surface points are enough: one of the neighbors of any other point would be nearer.
absl::StatusOr<Volume> ClosedByPoints(const Volume& object, const Volume& bricks, double radius,
                                      const exec::Context& context) {
  const std::vector<LatticePoint> ways = WaysInBall(radius, AxisScaleOf(object.placement()));
  const auto volume_of = [&](std::vector<BrickBits> bits) {
    return Volume::FromSortedBricks(object.extent(), object.placement(),
                                    {bricks.keys().begin(), bricks.keys().end()}, std::move(bits));
  };
  StopPoll poll(context);
  NearbyBricks nearby(bricks);
  std::vector<BrickBits> near(bricks.brick_count()), closed(bricks.brick_count());
  ForEachSurfacePoint(object, [&](LatticePoint p) {
    if (poll.Stopped()) return;
    for (LatticePoint way : ways) {
      const BrickAddress at = AddressOf(p + way);
      near[nearby.Find(at.brick)].Set(at.bit);
    }
  });
  const Volume around = Difference(volume_of(std::move(near)), object);
  const Volume grown = Union(object, around);
  NearbyBricks in_grown(grown);
  around.ForEachPoint([&](LatticePoint p) {
    if (poll.Stopped()) return;
    const auto is_grown = [&](LatticePoint way) { return in_grown.Contains(p + way); };
    if (!std::ranges::all_of(ways, is_grown)) return;
    const BrickAddress at = AddressOf(p);
    closed[nearby.Find(at.brick)].Set(at.bit);
  });
  if (poll.StoppedNow()) return context.StopStatus();
  return volume_of(std::move(closed));
}

}  // namespace

absl::StatusOr<Volume> OutOfReach(const Volume& object, double radius, exec::MemoryBudget& memory,
                                  const exec::Context& context) {
  const auto [by_points, room] = ClosingOf(object, radius);
  const Volume within = WithRoomAround(object, room);
  exec::MemoryShare share(memory);
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<BrickKey> keys, BricksToLookAt(within, room, share));
  std::vector<BrickBits> whole(keys.size(), ~BrickBits());
  const Volume bricks = Volume::FromSortedBricks(within.extent(), within.placement(),
                                                 std::move(keys), std::move(whole));
  BCCSKEL_ASSIGN_OR_RETURN(const Volume closed,
                           by_points ? ClosedByPoints(within, bricks, radius, context)
                                     : ClosedByDistances(within, bricks, radius, context));
  const LatticePoint moved = {2 * kBrickX * room.bx, 2 * kBrickY * room.by, 2 * kBrickZ * room.bz};
  // The builder drops points outside the extent.
  VolumeBuilder beyond(object.extent(), object.placement());
  Difference(closed, within).ForEachPoint([&](LatticePoint p) { beyond.Add(p - moved); });
  BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
  return std::move(beyond).Build();
}

absl::Status CheckRoomForBall(const Volume& object, double radius, exec::MemoryBudget& memory) {
  exec::MemoryShare share(memory);
  const BrickCoordinates room = ClosingOf(object, radius).room;
  return BricksToLookAt(WithRoomAround(object, room), room, share).status();
}

}  // namespace bccskel
