#include "core/prepare/fill_tunnels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/certificate/component_sets.h"
#include "core/distance/distance_field.h"
#include "core/exec/status_macros.h"
#include "core/lattice/directions.h"
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

constexpr BrickCoordinates Shifted(BrickCoordinates brick, BrickCoordinates by, int32_t times) {
  return {brick.bx + times * by.bx, brick.by + times * by.by, brick.bz + times * by.bz,
          brick.sublattice};
}

Volume ShiftedBy(const Volume& volume, BrickCoordinates by, int32_t times, LatticeExtent extent) {
  std::vector<BrickKey> keys;
  keys.reserve(volume.brick_count());
  for (BrickKey key : volume.keys()) {
    keys.push_back(BrickKey(Shifted(key.coordinates(), by, times)));
  }
  return Volume::FromSortedBricks(extent, volume.placement(), std::move(keys),
                                  {volume.bricks().begin(), volume.bricks().end()});
}

// Calls visit(key, a, b) for each brick that is stored in one of them, in order; what is not stored
// is empty.
template <typename Visit>
void ForEachBrickOf(const Volume& a, const Volume& b, Visit visit) {
  const BrickBits none;
  size_t m = 0, n = 0;
  while (m < a.brick_count() || n < b.brick_count()) {
    const bool in_a = m < a.brick_count() && (n == b.brick_count() || a.keys()[m] <= b.keys()[n]);
    const bool in_b = n < b.brick_count() && (m == a.brick_count() || b.keys()[n] <= a.keys()[m]);
    visit(in_a ? a.keys()[m] : b.keys()[n], in_a ? a.bricks()[m] : none,
          in_b ? b.bricks()[n] : none);
    m += in_a ? 1 : 0;
    n += in_b ? 1 : 0;
  }
}

// `join` makes a word of a word of each.
template <typename Join>
Volume Joined(const Volume& a, const Volume& b, Join join) {
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bricks;
  ForEachBrickOf(a, b, [&](BrickKey key, const BrickBits& in_a, const BrickBits& in_b) {
    keys.push_back(key);
    BrickBits& bits = bricks.emplace_back();
    for (size_t k = 0; k < 8; ++k) bits.words[k] = join(in_a.words[k], in_b.words[k]);
  });
  return Volume::FromSortedBricks(a.extent(), a.placement(), std::move(keys), std::move(bricks));
}
Volume Union(const Volume& a, const Volume& b) {
  return Joined(a, b, [](uint64_t x, uint64_t y) { return x | y; });
}
Volume Difference(const Volume& a, const Volume& b) {
  return Joined(a, b, [](uint64_t x, uint64_t y) { return x & ~y; });
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

// Sorted keys with those beside them, up to `reach` bricks away along one axis.
template <typename Step>
std::vector<BrickKey> Widened(const std::vector<BrickKey>& keys, int32_t reach, Step step) {
  std::vector<BrickKey> wide;
  wide.reserve(keys.size() * static_cast<size_t>(2 * reach + 1));
  for (BrickKey key : keys) {
    for (int32_t n = -reach; n <= reach; ++n) wide.push_back(BrickKey(step(key.coordinates(), n)));
  }
  std::ranges::sort(wide);
  wide.erase(std::unique(wide.begin(), wide.end()), wide.end());
  return wide;
}

// The bricks of an object, of both sublattices, with all around it up to `reach` bricks away.
// Needs: no coordinate below `reach`.
std::vector<BrickKey> BricksAround(const Volume& object, BrickCoordinates reach) {
  std::vector<BrickKey> keys;
  for (BrickKey key : object.keys()) {
    for (const Sublattice s : {Sublattice::kEven, Sublattice::kOdd}) {
      BrickCoordinates brick = key.coordinates();
      brick.sublattice = s;
      keys.push_back(BrickKey(brick));
    }
  }
  std::ranges::sort(keys);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  keys = Widened(keys, reach.bx, [](BrickCoordinates brick, int32_t n) {
    return Shifted(brick, {1, 0, 0}, n);
  });
  keys = Widened(keys, reach.by, [](BrickCoordinates brick, int32_t n) {
    return Shifted(brick, {0, 1, 0}, n);
  });
  return Widened(keys, reach.bz, [](BrickCoordinates brick, int32_t n) {
    return Shifted(brick, {0, 0, 1}, n);
  });
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

class TunnelFiller {
 public:
  // Distances go from center to center of points that are half a cell's edge, one unit, thick.
  TunnelFiller(const Volume& object, double width, exec::MemoryBudget& memory,
               const exec::Context& context)
      : object_(object),
        radius_(width / 2 + 1),
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
    // Nothing is known of what lies beyond the bricks that are looked at, and they count as
    // background. That is wrong by up to two radii from there, and matters to the closing up to two
    // radii from the object.
    const auto reach = [&](int32_t cells) {
      return static_cast<int32_t>(std::ceil((4 * radius_ + 2) / (2 * cells)));
    };
    const BrickCoordinates room = {reach(kBrickX), reach(kBrickY), reach(kBrickZ)};
    const LatticeExtent& given = object_.extent();
    const auto bricks = [](int32_t cells, int32_t per_brick, int32_t more) {
      return ((cells + per_brick - 1) / per_brick + 2 * more) * per_brick;
    };
    const LatticeExtent extent = {bricks(given.nx, kBrickX, room.bx),
                                  bricks(given.ny, kBrickY, room.by),
                                  bricks(given.nz, kBrickZ, room.bz)};
    const Volume object = ShiftedBy(object_, room, 1, extent);
    std::vector<BrickKey> keys = BricksAround(object, room);
    exec::MemoryShare share(memory_);
    BCCSKEL_RETURN_IF_ERROR(
        share.TakeFor(keys.size(), kBytesPerRoomBrick, "bricks to look for tunnels in"));
    BrickBits all;
    all.words.fill(~uint64_t{0});
    std::vector<BrickBits> whole(keys.size(), all);
    const Volume around = Difference(
        Volume::FromSortedBricks(extent, object.placement(), std::move(keys), std::move(whole)),
        object);
    BCCSKEL_ASSIGN_OR_RETURN(const Volume near, Near(around));
    const Volume grown = Union(object, near);
    BCCSKEL_ASSIGN_OR_RETURN(const DistanceField depth,
                             ComputeDistance(grown, DistanceKind::kEuclidean, context_));
    const Volume closed =
        PointsAt(grown, depth, [&](double distance) { return distance >= radius_; });
    // The builder drops what lies outside the extent.
    VolumeBuilder pieces(given, object_.placement());
    Difference(closed, object).ForEachPoint([&](LatticePoint p) {
      pieces.Add(p -
                 LatticePoint{2 * kBrickX * room.bx, 2 * kBrickY * room.by, 2 * kBrickZ * room.bz});
    });
    BCCSKEL_ASSIGN_OR_RETURN(pieces_, std::move(pieces).Build());
    return context_.StopStatus();
  }

  absl::StatusOr<Volume> Near(const Volume& around) {
    BCCSKEL_ASSIGN_OR_RETURN(const DistanceField distance,
                             ComputeDistance(around, DistanceKind::kEuclidean, context_));
    return PointsAt(around, distance, [&](double far) { return far < radius_; });
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

  // A few pieces together may close the mouths of what then is a cavity.
  absl::Status RefuseNewCavities() {
    while (true) {
      filled_ = Filled();
      BCCSKEL_ASSIGN_OR_RETURN(const Volume closed, CavitiesFilled(filled_));
      const Volume enclosed = Difference(Difference(closed, filled_), cavities_filled_);
      if (enclosed.empty()) return context_.StopStatus();
      enclosed.ForEachPoint([&](LatticePoint p) {
        for (LatticePoint offset : kDirections14) {
          if (pieces_.Contains(p + offset)) PieceOf(p + offset).refused = true;
        }
      });
      BCCSKEL_RETURN_IF_ERROR(context_.StopStatus());
    }
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

}  // namespace

absl::StatusOr<ChangedVolume> FillTunnels(const Volume& object, double width,
                                          exec::MemoryBudget& memory,
                                          const exec::Context& context) {
  ChangedVolume all{object};
  if (object.empty()) return all;
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
