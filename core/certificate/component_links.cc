#include "core/certificate/component_links.h"

#include <bit>

#include "core/certificate/brick_contacts.h"

namespace bccskel {
namespace {

constexpr bool IsDownward(Direction d) { return d.offset().x + d.offset().y + d.offset().z < 0; }

// Each pair of neighboring bricks is processed from one side: even from odd, + from -.
constexpr PositionMask ComputeLinkedFrom(Sublattice sublattice) {
  PositionMask linked = sublattice == Sublattice::kEven ? 0xff : 0;
  for (int position = 8; position < kNeighborCount; ++position) {
    linked |= (IsDownward(Direction(position)) ? 1u : 0u) << position;
  }
  return linked;
}
constexpr std::array<PositionMask, 2> kLinkedFrom = {ComputeLinkedFrom(Sublattice::kEven),
                                                     ComputeLinkedFrom(Sublattice::kOdd)};

// The points of a set without a predecessor along x, y or z: at least one of each connected part.
BrickBits FirstOfParts(const BrickBits& points) {
  constexpr uint64_t kFirstOfRows = 0x0001000100010001;
  BrickBits first;
  for (size_t k = 0; k < 8; ++k) {
    const uint64_t word = points.words[k], below = k > 0 ? points.words[k - 1] : 0;
    first.words[k] = word & ~((word << 1 & ~kFirstOfRows) | word << 16 | below);
  }
  return first;
}

template <typename Visit>
void ForEachPosition(PositionMask positions, Visit visit) {
  for (; positions != 0; positions &= positions - 1) visit(std::countr_zero(positions));
}

// The positions of `among` that are connected with `position`, including itself.
PositionMask GroupOf(int position, PositionMask among, Sublattice sublattice) {
  const BrickContacts& contacts = ContactsOf(sublattice);
  PositionMask group = 0;
  for (PositionMask fresh = 1u << position; fresh != 0;) {
    group |= fresh;
    PositionMask reached = 0;
    ForEachPosition(fresh, [&](int at) { reached |= contacts.beside[static_cast<size_t>(at)]; });
    fresh = reached & among & ~group;
  }
  return group;
}

}  // namespace

int64_t ComponentLinks::LinkBrick(BrickIndex n, GapPlaces& places) {
  if (!components_.HasPoints(n)) return 0;
  const BricksAround around = LookAround(n);
  const PositionMask missing =
      gaps_ == nullptr || around.missing == 0 ? 0 : around.missing & KnownAround(n);
  const PositionMask open = missing | around.in_other_sets;
  int64_t joined = 0;
  if (open != 0) {
    const PositionMask touched =
        open & FindTouchedBricks(SublatticeAt(n), components_.mains(), n, neighbors_[n]);
    joined += LinkMains(n, touched & around.in_other_sets);
    joined += LinkMainToGaps(n, touched & missing, missing, places);
  }
  if (components_.fragments(n) == nullptr) return joined;
  joined += LinkFragments(n);
  ForEachPosition(missing,
                  [&](int position) { joined += LinkFragmentsToGap(n, position, places); });
  return joined;
}

// Most adjacent bricks are in the same set already, through bricks linked before, and most of those
// directly below the root of the set.
ComponentLinks::BricksAround ComponentLinks::LookAround(BrickIndex n) {
  const size_t root = sets_.Find(n), stored = object_.brick_count();
  BricksAround around = {0, 0};
  for (int position = 0; position < kNeighborCount; ++position) {
    const BrickIndex other = NeighborAt(n, position);
    around.missing |= (other < stored ? 0u : 1u) << position;
    around.in_other_sets |= (sets_.IsRightBelow(other, root) ? 0u : 1u) << position;
  }
  around.in_other_sets &= kLinkedFrom[static_cast<size_t>(SublatticeAt(n))] & ~around.missing;
  ForEachPosition(around.in_other_sets, [&](int position) {
    const BrickIndex other = NeighborAt(n, position);
    if (components_.HasPoints(other) && sets_.Find(other) != root) return;
    around.in_other_sets &= ~(1u << position);
  });
  return around;
}

// The positions in known layers.
PositionMask ComponentLinks::KnownAround(BrickIndex n) const {
  const BrickCoordinates brick = object_.keys()[n].coordinates();
  PositionMask known = ~PositionMask{0};
  if (gaps_->known().Has(brick.bz - 1) && gaps_->known().Has(brick.bz + 1)) return known;
  for (int position = 0; position < kNeighborCount; ++position) {
    if (gaps_->known().Has(NeighborBrick(brick, position).bz)) continue;
    known &= ~(PositionMask{1} << position);
  }
  return known;
}

int64_t ComponentLinks::LinkMains(BrickIndex n, PositionMask touched) {
  int64_t joined = 0;
  ForEachPosition(touched, [&](int position) { joined += Unite(n, NeighborAt(n, position)); });
  return joined;
}

// Bricks that are not stored are all background, and gaps that touch each other are linked: one of
// each group is enough.
int64_t ComponentLinks::LinkMainToGaps(BrickIndex n, PositionMask touched, PositionMask missing,
                                       GapPlaces& places) {
  int64_t joined = 0;
  while (touched != 0) {
    const int position = std::countr_zero(touched);
    joined += Unite(n, GapAt(n, position, places));
    touched &= ~GroupOf(position, missing, SublatticeAt(n));
  }
  return joined;
}

size_t ComponentLinks::GapAt(BrickIndex n, int position, GapPlaces& places) const {
  const BrickCoordinates brick = object_.keys()[n].coordinates();
  return components_.number_limit() +
         gaps_->NodeAt(NeighborBrick(brick, position), places.of(brick, position));
}

// Links fragments to all components that they touch in other bricks.
int64_t ComponentLinks::LinkFragments(BrickIndex n) {
  BrickSurroundings bricks{components_.PointsOf(n), {}};
  for (size_t position = 0; position < kNeighborCount; ++position) {
    const BrickIndex other = neighbors_[n][position];
    if (IsStored(other)) bricks.around[position] = components_.PointsOf(other);
  }
  const NeighborPlanes planes = FindNeighborPlanes(SublatticeAt(n), bricks);
  int64_t joined = 0;
  for (int d = 0; d < kNeighborCount; ++d) {
    joined += LinkFragmentsAlong(n, Direction(d), planes[static_cast<size_t>(d)]);
  }
  return joined;
}

// Adjacent points whose neighbors are in one other brick link the same two components.
int64_t ComponentLinks::LinkFragmentsAlong(BrickIndex n, Direction d,
                                           const BrickBits& having_neighbor) {
  const Sublattice sublattice = SublatticeAt(n);
  const BrickBits points = components_.fragments(n)->fragments & having_neighbor;
  if (points.Empty()) return 0;
  int64_t joined = 0;
  for (const BrickContact& contact : ContactsOf(sublattice).along[static_cast<size_t>(d.bit())]) {
    const BrickBits leaving = points & contact.points;
    if (leaving.Empty()) continue;
    const BrickIndex other = NeighborAt(n, contact.position);
    FirstOfParts(leaving).ForEachSetBit([&](int bit) {
      joined += Unite(components_.NumberOf(n, bit),
                      components_.NumberOf(other, NeighborBit(sublattice, d, bit)));
    });
  }
  return joined;
}

int64_t ComponentLinks::LinkFragmentsToGap(BrickIndex n, int position, GapPlaces& places) {
  const BrickBits& contact = ContactsOf(SublatticeAt(n)).points_at[static_cast<size_t>(position)];
  const BrickBits touching = components_.fragments(n)->fragments & contact;
  if (touching.Empty()) return 0;
  const size_t gap = GapAt(n, position, places);
  int64_t joined = 0;
  FirstOfParts(touching).ForEachSetBit(
      [&](int bit) { joined += Unite(components_.NumberOf(n, bit), gap); });
  return joined;
}

}  // namespace bccskel
