#include "core/prepare/fill_tunnels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/certificate/component_sets.h"
#include "core/certificate/neighbor_planes.h"
#include "core/certificate/union_find.h"
#include "core/distance/chamfer_weights.h"
#include "core/distance/distance_field.h"
#include "core/distance/places.h"
#include "core/exec/status_macros.h"
#include "core/exec/stop_poll.h"
#include "core/lattice/directions.h"
#include "core/prepare/brick_sets.h"
#include "core/prepare/fill_cavities.h"
#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

// Of the bricks around the object: a distance field while it is made, and bits.
constexpr uint64_t kBytesPerRoomBrick = 5120;
// Of the object with its cavities filled: bits, three times.
constexpr uint64_t kBytesPerCavityBrick = 256;
// As much as the pipeline needs for a brick of an object.
constexpr uint64_t kBytesPerNewBrick = 5120;

// In lattice units: that of a voxel missing in a wall.
constexpr double kNarrowest = 2;
// A ball of at most this radius is compared point by point: distance fields take up to five times
// as long.
constexpr double kFewPoints = 5;
// So is a larger one if it has so few points for each brick of the distance fields: the bricks
// around dust are many times those that it lies in.
constexpr double kVisitsPerBrick = 32;

// As distance fields have it.
double RoundedLength(LatticePoint way, const AxisScale& scale) {
  const auto square = [](double length) { return static_cast<float>(length * length); };
  const auto x = static_cast<float>(std::abs(way.x));
  const float squared =
      x * x * square(scale[0]) + square(scale[1] * way.y) + square(scale[2] * way.z);
  return std::sqrt(static_cast<double>(squared));
}

// The way from the middle of the ball to each other point in it, the farthest first: most points
// near an object have background there.
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

// The points with background beside them.
template <typename Visit>
void ForEachSurfacePoint(const Volume& object, Visit visit) {
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    BrickBits surface;
    for (const BrickBits& plane : NeighborPlanesOf(object, n)) {
      for (size_t w = 0; w < plane.words.size(); ++w) surface.words[w] |= ~plane.words[w];
    }
    for (size_t w = 0; w < surface.words.size(); ++w) {
      surface.words[w] &= object.bricks()[n].words[w];
    }
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

// How the Euler characteristic changes when a point with these object neighbors joins them.
// Source: 1 - chi(link), where chi = b0 - b1, and on a sphere b1 of the object's part is one less
//         than b0 of the rest.
int EulerOfJoining(NeighborMask mask) {
  if (mask == 0) return 1;
  if (mask == kAllNeighbors) return -1;
  const auto rest = static_cast<NeighborMask>(kAllNeighbors & ~mask);
  return 1 - (ComponentsIn(mask) - (ComponentsIn(rest) - 1));
}

// How a ball is compared with the object, and how far around it one has to look.
struct Closing {
  bool by_points = false;
  BrickCoordinates room;
};

// Nothing is known of what lies beyond the bricks that are looked at, and they count as background.
// That is wrong by up to two radii from there, and matters to the closing up to two radii from the
// object.
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

// Reserves and lists the bricks to look at.
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

double RadiusOf(double width) { return width / 2 + 1; }

class TunnelFiller {
 public:
  // Distances go from center to center of points that are half a cell's edge, one unit, thick.
  TunnelFiller(const Volume& object, double width, exec::MemoryBudget& memory,
               const exec::Context& context)
      : object_(object),
        radius_(RadiusOf(width)),
        memory_(memory),
        context_(context),
        for_cavities_(memory) {}

  absl::StatusOr<ChangedVolume> Run() && {
    BCCSKEL_RETURN_IF_ERROR(CloseObject());
    if (pieces_.empty()) return ChangedVolume{object_};
    BCCSKEL_RETURN_IF_ERROR(JudgePieces());
    BCCSKEL_RETURN_IF_ERROR(RefuseNewCavities());
    return Result();
  }

 private:
  struct Piece {
    static constexpr size_t kNone = std::numeric_limits<size_t>::max();
    int64_t euler = 0;       // what filling it adds
    size_t touches = kNone;  // a component of the object
    bool refused = false;

    bool IsFilled() const { return !refused && touches != kNone && euler > 0; }
  };

  // Sets pieces_: what the ball does not reach, without the object.
  absl::Status CloseObject() {
    const auto [by_points, room] = ClosingOf(object_, radius_);
    const Volume object = WithRoomAround(object_, room);
    exec::MemoryShare share(memory_);
    BCCSKEL_ASSIGN_OR_RETURN(std::vector<BrickKey> keys, BricksToLookAt(object, room, share));
    BrickBits all;
    all.words.fill(~uint64_t{0});
    std::vector<BrickBits> whole(keys.size(), all);
    const Volume bricks = Volume::FromSortedBricks(object.extent(), object.placement(),
                                                   std::move(keys), std::move(whole));
    BCCSKEL_ASSIGN_OR_RETURN(const Volume closed, by_points ? ClosedByPoints(object, bricks)
                                                            : ClosedByDistances(object, bricks));
    // The builder drops what lies outside the extent.
    VolumeBuilder pieces(object_.extent(), object_.placement());
    Difference(closed, object).ForEachPoint([&](LatticePoint p) {
      pieces.Add(p -
                 LatticePoint{2 * kBrickX * room.bx, 2 * kBrickY * room.by, 2 * kBrickZ * room.bz});
    });
    BCCSKEL_ASSIGN_OR_RETURN(pieces_, std::move(pieces).Build());
    return context_.StopStatus();
  }

  absl::StatusOr<Volume> ClosedByDistances(const Volume& object, const Volume& bricks) const {
    const Volume around = Difference(bricks, object);
    BCCSKEL_ASSIGN_OR_RETURN(const DistanceField distance,
                             ComputeDistance(around, DistanceKind::kEuclidean, context_));
    const Volume near = PointsAt(around, distance, [&](double far) { return far < radius_; });
    const Volume grown = Union(object, near);
    BCCSKEL_ASSIGN_OR_RETURN(const DistanceField depth,
                             ComputeDistance(grown, DistanceKind::kEuclidean, context_));
    return PointsAt(grown, depth, [&](double deep) { return deep >= radius_; });
  }

  // The nearest point of the object is one of its surface: one of its neighbors would be nearer.
  absl::StatusOr<Volume> ClosedByPoints(const Volume& object, const Volume& bricks) const {
    const std::vector<LatticePoint> ways = WaysInBall(radius_, AxisScaleOf(object.placement()));
    const auto volume_of = [&](std::vector<BrickBits> bits) {
      return Volume::FromSortedBricks(object.extent(), object.placement(),
                                      {bricks.keys().begin(), bricks.keys().end()},
                                      std::move(bits));
    };
    StopPoll poll(context_);
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
    if (poll.StoppedNow()) return context_.StopStatus();
    return volume_of(std::move(closed));
  }

  // Sets judged_.
  absl::Status JudgePieces() {
    BCCSKEL_ASSIGN_OR_RETURN(const uint64_t bricks, BricksWithCavitiesFilled(object_, context_));
    BCCSKEL_RETURN_IF_ERROR(
        for_cavities_.TakeFor(bricks, kBytesPerCavityBrick, "bricks with cavities"));
    BCCSKEL_ASSIGN_OR_RETURN(cavities_filled_, CavitiesFilled(object_));
    ComponentSets components(object_, Phase::kObject, context_);
    names_.emplace(pieces_, Phase::kObject, context_);
    BCCSKEL_RETURN_IF_ERROR(context_.StopStatus());
    judged_.resize(names_->name_limit());
    pieces_.ForEachPoint([&](LatticePoint p) { Judge(p, components); });
    return context_.StopStatus();
  }

  Piece& PieceOf(LatticePoint p) { return judged_[ComponentOf(pieces_, *names_, p)]; }

  // Needs: p is a point of `volume`.
  static size_t ComponentOf(const Volume& volume, ComponentSets& sets, LatticePoint p) {
    const BrickAddress at = AddressOf(p);
    return sets.SetOf(sets.pieces().NumberOf(*volume.Find(BrickKey(at.brick)), at.bit));
  }

  // Points join in the order of ForEachPoint(). Pieces do not touch each other, so each has its own
  // sum.
  void Judge(LatticePoint p, ComponentSets& components) {
    Piece& piece = PieceOf(p);
    if (cavities_filled_.Contains(p)) piece.refused = true;
    NeighborMask mask = 0;
    for (int n = 0; n < kNeighborCount; ++n) {
      const LatticePoint q = p + Direction(n).offset();
      if (object_.Contains(q)) {
        mask = static_cast<NeighborMask>(mask | Direction(n).mask());
        const size_t component = ComponentOf(object_, components, q);
        if (piece.touches == Piece::kNone) piece.touches = component;
        if (piece.touches != component) piece.refused = true;
      } else if (cavities_filled_.Contains(q)) {
        piece.refused = true;
      } else if (pieces_.Contains(q) && ComesBefore(q, p)) {
        mask = static_cast<NeighborMask>(mask | Direction(n).mask());
      }
    }
    piece.euler += EulerOfJoining(mask);
  }

  static bool ComesBefore(LatticePoint q, LatticePoint p) {
    const BrickAddress a = AddressOf(q), b = AddressOf(p);
    return std::pair(BrickKey(a.brick), a.bit) < std::pair(BrickKey(b.brick), b.bit);
  }

  // The object with the pieces that are not refused.
  Volume Filled() {
    VolumeBuilder filled(object_.extent(), object_.placement());
    pieces_.ForEachPoint([&](LatticePoint p) {
      if (PieceOf(p).IsFilled()) filled.Add(p);
    });
    return Union(object_, *std::move(filled).Build());
  }

  // What is enclosed, and the object.
  absl::StatusOr<Volume> CavitiesFilled(const Volume& object) const {
    BCCSKEL_ASSIGN_OR_RETURN(
        ChangedVolume filled,
        FillCavities(object, std::numeric_limits<uint32_t>::max() - 1, context_));
    return std::move(filled.object);
  }

  // What a piece that would be filled leads to: background that would be enclosed, or the outside.
  struct Way {
    size_t piece = 0;
    std::vector<size_t> regions;
  };

  // Pieces may close all mouths of what then is a cavity. As many stay open as connect each such
  // region with the outside, those first that cost the fewest loops (Kruskal's algorithm). More are
  // not needed: a piece is connected, and so was the background before.
  absl::Status RefuseNewCavities() {
    filled_ = Filled();
    BCCSKEL_ASSIGN_OR_RETURN(const Volume closed, CavitiesFilled(filled_));
    const Volume enclosed = Difference(Difference(closed, filled_), cavities_filled_);
    if (enclosed.empty()) return context_.StopStatus();
    ComponentSets regions(enclosed, Phase::kObject, context_);
    BCCSKEL_RETURN_IF_ERROR(context_.StopStatus());
    const size_t outside = regions.name_limit();
    std::vector<Way> ways = WaysToRegions(closed, enclosed, regions);
    std::ranges::stable_sort(ways, {}, [&](const Way& way) { return judged_[way.piece].euler; });
    UnionFind connected(outside + 1);
    for (const Way& way : ways) {
      for (size_t region : way.regions) {
        if (connected.Unite(way.regions.front(), region)) judged_[way.piece].refused = true;
      }
    }
    filled_ = Filled();
    return context_.StopStatus();
  }

  // In the order of the pieces' first points, since names depend on threads.
  std::vector<Way> WaysToRegions(const Volume& closed, const Volume& enclosed,
                                 ComponentSets& regions) {
    constexpr size_t kNone = std::numeric_limits<size_t>::max();
    std::vector<size_t> way_of(judged_.size(), kNone);
    std::vector<Way> ways;
    pieces_.ForEachPoint([&](LatticePoint p) {
      const size_t piece = ComponentOf(pieces_, *names_, p);
      if (!judged_[piece].IsFilled()) return;
      if (way_of[piece] == kNone) {
        way_of[piece] = ways.size();
        ways.push_back({.piece = piece, .regions = {}});
      }
      std::vector<size_t>& leads_to = ways[way_of[piece]].regions;
      for (LatticePoint offset : kDirections14) {
        const LatticePoint q = p + offset;
        if (closed.Contains(q) && !enclosed.Contains(q)) continue;
        const size_t region =
            closed.Contains(q) ? ComponentOf(enclosed, regions, q) : regions.name_limit();
        if (leads_to.empty() || leads_to.back() != region) leads_to.push_back(region);
      }
    });
    return ways;
  }

  absl::StatusOr<ChangedVolume> Result() {
    if (filled_.brick_count() > object_.brick_count()) {
      BCCSKEL_RETURN_IF_ERROR(memory_.TakeFor(filled_.brick_count() - object_.brick_count(),
                                              kBytesPerNewBrick, "bricks with filled tunnels"));
    }
    ChangedVolume result;
    for (const Piece& piece : judged_) {
      if (piece.IsFilled()) result.count += static_cast<uint64_t>(piece.euler);
    }
    result.points_added = filled_.PointCount() - object_.PointCount();
    result.object = std::move(filled_);
    return result;
  }

  const Volume& object_;
  const double radius_;
  exec::MemoryBudget& memory_;
  const exec::Context& context_;
  exec::MemoryShare for_cavities_;
  Volume pieces_, cavities_filled_, filled_;
  std::optional<ComponentSets> names_;  // of the pieces
  std::vector<Piece> judged_;           // by name
};

// The widest ball needs most, and no less once narrower ones have filled something.
absl::Status CheckRoomFor(const Volume& object, double radius, exec::MemoryBudget& memory) {
  exec::MemoryShare share(memory);
  const BrickCoordinates room = ClosingOf(object, radius).room;
  return BricksToLookAt(WithRoomAround(object, room), room, share).status();
}

}  // namespace

absl::StatusOr<ChangedVolume> FillTunnels(const Volume& object, double width,
                                          exec::MemoryBudget& memory,
                                          const exec::Context& context) {
  ChangedVolume all{object};
  if (object.empty()) return all;
  if (width > kNarrowest) {
    BCCSKEL_RETURN_IF_ERROR(CheckRoomFor(object, RadiusOf(width), memory));
  }
  for (double now = std::min(width, kNarrowest);; now = std::min(2 * now, width)) {
    BCCSKEL_ASSIGN_OR_RETURN(ChangedVolume filled,
                             TunnelFiller(all.object, now, memory, context).Run());
    all.object = std::move(filled.object);
    all.count += filled.count;
    all.points_added += filled.points_added;
    if (now >= width) return all;
  }
}

}  // namespace bccskel
