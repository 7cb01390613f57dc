#include "core/certificate/component_links.h"

#include <algorithm>

#include "core/certificate/brick_contacts.h"
#include "core/certificate/neighbor_planes.h"

namespace bccskel {
namespace {

constexpr BrickBits kNothing;

constexpr bool IsDownward(Direction d) { return d.offset().x + d.offset().y + d.offset().z < 0; }

// Each pair of neighboring bricks is looked at from one side: even from odd, + from -.
constexpr bool IsLinkedFrom(Sublattice sublattice, int position) {
  return position < 8 ? sublattice == Sublattice::kEven : IsDownward(Direction(position));
}

bool Intersect(const BrickBits& a, const BrickBits& b) {
  uint64_t both = 0;
  for (size_t k = 0; k < 8; ++k) both |= a.words[k] & b.words[k];
  return both != 0;
}

BrickBits Intersection(const BrickBits& a, const BrickBits& b) {
  BrickBits both;
  for (size_t k = 0; k < 8; ++k) both.words[k] = a.words[k] & b.words[k];
  return both;
}

}  // namespace

int64_t ComponentLinks::LinkBrick(BrickIndex n, GapPlaces& places) {
  if (!components_.HasPoints(n)) return 0;
  int64_t joined = 0;
  for (int position = 0; position < kNeighborCount; ++position) {
    if (IsStored(NeighborAt(n, position))) {
      if (IsLinkedFrom(SublatticeAt(n), position)) joined += LinkMains(n, position);
    } else if (gaps_ != nullptr) {
      joined += LinkToGap(n, position, places);
    }
  }
  if (!HasFragmentsAround(n)) return joined;
  for (int d = 0; d < kNeighborCount; ++d) {
    if (IsDownward(Direction(d))) joined += LinkFragments(n, Direction(d));
  }
  return joined;
}

// Most pairs of bricks are in one set already, by way of bricks linked before; of the rest most
// touch along the first direction tried.
int64_t ComponentLinks::LinkMains(BrickIndex n, int position) {
  const BrickIndex other = NeighborAt(n, position);
  if (!components_.HasPoints(other)) return 0;
  if (sets_.Find(MainMember(n)) == sets_.Find(MainMember(other))) return 0;
  const Sublattice sublattice = SublatticeAt(n);
  const BrickBits own = components_.MainPointsOf(n), beyond = components_.MainPointsOf(other);
  for (const BrickContact& contact : ContactsOf(sublattice).at[static_cast<size_t>(position)]) {
    const BrickBits plane = NeighborPlane(
        contact.direction, sublattice, kNothing,
        [&](int at) -> const BrickBits& { return at == position ? beyond : kNothing; });
    if (Intersect(own, plane)) return Unite(MainMember(n), MainMember(other));
  }
  return 0;
}

bool ComponentLinks::HasFragmentsAround(BrickIndex n) const {
  if (components_.fragments(n) != nullptr) return true;
  return std::ranges::any_of(
      neighbors_[n], [this](BrickIndex other) { return components_.fragments(other) != nullptr; });
}

// Pairs of neighboring points of which at least one is outside its brick's main component.
int64_t ComponentLinks::LinkFragments(BrickIndex n, Direction d) {
  const Sublattice sublattice = SublatticeAt(n);
  const BrickBits own = components_.FragmentPointsOf(n), all = components_.PointsOf(n);
  const BrickBits plane = NeighborPlane(d, sublattice, own, [&](int position) {
    return components_.FragmentPointsOf(NeighborAt(n, position));
  });
  const BrickBits all_plane = NeighborPlane(d, sublattice, all, [&](int position) {
    return components_.PointsOf(NeighborAt(n, position));
  });
  BrickBits pairs;
  for (size_t k = 0; k < 8; ++k) {
    pairs.words[k] = (own.words[k] & all_plane.words[k]) | (all.words[k] & plane.words[k]);
  }
  if (pairs.Empty()) return 0;
  int64_t joined = 0;
  for (const BrickContact& contact : ContactsOf(sublattice).along[static_cast<size_t>(d.bit())]) {
    const BrickIndex other = NeighborAt(n, contact.position);
    Intersection(pairs, contact.points).ForEachSetBit([&](int bit) {
      joined += Unite(MemberOf(n, bit), MemberOf(other, NeighborBit(sublattice, d, bit)));
    });
  }
  return joined;
}

// A brick that is not stored is background all over.
int64_t ComponentLinks::LinkToGap(BrickIndex n, int position, GapPlaces& places) {
  const BrickCoordinates brick = object_.keys()[n].coordinates();
  const BrickBits& contact = ContactsOf(brick.sublattice).points_at[static_cast<size_t>(position)];
  const size_t gap = gaps_->NodeAt(NeighborBrick(brick, position), places.of(brick, position));
  int64_t joined = 0;
  if (Intersect(components_.MainPointsOf(n), contact)) joined += Unite(MainMember(n), gap);
  if (components_.fragments(n) == nullptr) return joined;
  Intersection(components_.FragmentPointsOf(n), contact).ForEachSetBit([&](int bit) {
    joined += Unite(MemberOf(n, bit), gap);
  });
  return joined;
}

}  // namespace bccskel
