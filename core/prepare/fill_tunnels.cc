#include "core/prepare/fill_tunnels.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/certificate/component_sets.h"
#include "core/exec/status_macros.h"
#include "core/exec/union_find.h"
#include "core/lattice/directions.h"
#include "core/prepare/ball_closing.h"
#include "core/prepare/brick_sets.h"
#include "core/prepare/fill_cavities.h"
#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

// Memory per brick of the object with its cavities filled: bits, three times.
constexpr uint64_t kBytesPerCavityBrick = 256;
// The memory that the pipeline needs per brick of an object.
constexpr uint64_t kBytesPerNewBrick = 5120;

// In lattice units: the width of a missing voxel in a wall.
constexpr double kNarrowest = 2;

// The change of the Euler characteristic when a point with these object neighbors joins them.
// Source: 1 - chi(link), where chi = b0 - b1, and on a sphere b1 of the object's part is one less
//         than b0 of the rest.
int EulerOfJoining(NeighborMask mask) {
  if (mask == 0) return 1;
  if (mask == kAllNeighbors) return -1;
  const auto rest = static_cast<NeighborMask>(kAllNeighbors & ~mask);
  return 1 - (ComponentsIn(mask) - (ComponentsIn(rest) - 1));
}

double RadiusOf(double width) { return width / 2 + 1; }

class TunnelFiller {
 public:
  // Distances are measured between the centers of points, each half a cell's edge, one unit, thick.
  TunnelFiller(const Volume& object, double width, exec::MemoryBudget& memory,
               const exec::Context& context)
      : object_(object),
        radius_(RadiusOf(width)),
        memory_(memory),
        context_(context),
        for_cavities_(memory) {}

  absl::StatusOr<ChangedVolume> Run() && {
    BCCSKEL_ASSIGN_OR_RETURN(pieces_, OutOfReach(object_, radius_, memory_, context_));
    if (pieces_.empty()) return ChangedVolume{object_};
    BCCSKEL_RETURN_IF_ERROR(JudgePieces());
    BCCSKEL_RETURN_IF_ERROR(RefuseNewCavities());
    return Result();
  }

 private:
  struct Piece {
    static constexpr size_t kNone = std::numeric_limits<size_t>::max();
    int64_t euler = 0;       // change of the Euler characteristic by filling it
    size_t touches = kNone;  // a component of the object
    bool refused = false;

    bool IsFilled() const { return !refused && touches != kNone && euler > 0; }
  };

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

  Piece& PieceOf(LatticePoint p) { return judged_[names_->ComponentOf(pieces_, p)]; }

  // Points join in the order of ForEachPoint(). Pieces do not touch each other, so each has its own
  // sum.
  void Judge(LatticePoint p, ComponentSets& components) {
    Piece& piece = PieceOf(p);
    if (cavities_filled_.Contains(p)) piece.refused = true;
    NeighborMask mask = 0;
    ForEachDirection(kAllNeighbors, [&](Direction d) {
      const LatticePoint q = p + d.offset();
      if (object_.Contains(q)) {
        mask = With(mask, d);
        const size_t component = components.ComponentOf(object_, q);
        if (piece.touches == Piece::kNone) piece.touches = component;
        if (piece.touches != component) piece.refused = true;
      } else if (cavities_filled_.Contains(q)) {
        piece.refused = true;
      } else if (pieces_.Contains(q) && ComesBefore(q, p)) {
        mask = With(mask, d);
      }
    });
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

  // The object and everything that it encloses.
  absl::StatusOr<Volume> CavitiesFilled(const Volume& object) const {
    BCCSKEL_ASSIGN_OR_RETURN(
        ChangedVolume filled,
        FillCavities(object, std::numeric_limits<uint32_t>::max() - 1, context_));
    return std::move(filled.object);
  }

  // A connection from a piece that would be filled to background that would be enclosed, or to the
  // outside.
  struct Way {
    size_t piece = 0;
    std::vector<size_t> regions;
  };

  // Pieces may close all openings of a region, which would become a cavity. As many pieces stay
  // open as connect each such region with the outside, those that cost the fewest loops first
  // (Kruskal's algorithm). More are not needed: a piece is connected, and so was the background.
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
    UnionFind<size_t> connected(outside + 1);
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
      const size_t piece = names_->ComponentOf(pieces_, p);
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
            closed.Contains(q) ? regions.ComponentOf(enclosed, q) : regions.name_limit();
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

}  // namespace

absl::StatusOr<ChangedVolume> FillTunnels(const Volume& object, double width,
                                          exec::MemoryBudget& memory,
                                          const exec::Context& context) {
  ChangedVolume all{object};
  if (object.empty()) return all;
  if (width > kNarrowest) {  // the widest ball needs the most memory
    BCCSKEL_RETURN_IF_ERROR(CheckRoomForBall(object, RadiusOf(width), memory));
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
