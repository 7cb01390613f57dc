#include "core/certificate/component_links.h"

#include "core/certificate/brick_contacts.h"
#include "core/certificate/neighbor_planes.h"

namespace bccskel {
namespace {

constexpr bool IsDownward(Direction d) { return d.offset().x + d.offset().y + d.offset().z < 0; }

bool Intersect(const BrickBits& a, const BrickBits& b) {
  uint64_t both = 0;
  for (size_t k = 0; k < 8; ++k) both |= a.words[k] & b.words[k];
  return both != 0;
}

bool Intersect(const BrickBits& a, const BrickBits& b, const BrickBits& c) {
  uint64_t all = 0;
  for (size_t k = 0; k < 8; ++k) all |= a.words[k] & b.words[k] & c.words[k];
  return all != 0;
}

BrickBits Intersection(const BrickBits& a, const BrickBits& b) {
  BrickBits both;
  for (size_t k = 0; k < 8; ++k) both.words[k] = a.words[k] & b.words[k];
  return both;
}

}  // namespace

int64_t ComponentLinks::LinkBrick(BrickIndex n) {
  if (!components_.HasPoints(n)) return 0;
  int64_t joined = 0;
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    if (IsDownward(Direction(bit))) joined += LinkAlong(n, Direction(bit));
    if (gaps_ != nullptr && !IsStored(NeighborAt(n, bit))) joined += LinkToGap(n, bit);
  }
  return joined;
}

// Most pairs of bricks are in one set already, by way of bricks linked before.
bool ComponentLinks::NeedsLink(BrickIndex n, Direction d) const {
  const size_t own = sets_.Find(MainMember(n));
  for (const BrickContact& contact : ContactsAlong(SublatticeAt(n), d)) {
    const BrickIndex other = NeighborAt(n, contact.position);
    if (!IsStored(other) || !components_.HasPoints(other)) continue;
    if (components_.fragments(other) != nullptr) return true;
    if (sets_.Find(MainMember(other)) != own) return true;
  }
  return components_.fragments(n) != nullptr;
}

int64_t ComponentLinks::LinkAlong(BrickIndex n, Direction d) {
  if (!NeedsLink(n, d)) return 0;
  const BrickBits main = components_.MainPointsOf(n);
  const BrickBits plane = NeighborPlane(d, SublatticeAt(n), main, [&](int position) {
    return components_.MainPointsOf(NeighborAt(n, position));
  });
  int64_t joined = 0;
  for (const BrickContact& contact : ContactsAlong(SublatticeAt(n), d)) {
    if (!Intersect(main, plane, contact.points)) continue;
    joined += Unite(MainMember(n), MainMember(NeighborAt(n, contact.position)));
  }
  return joined + LinkFragments(n, d, plane);
}

// Pairs of neighboring points of which at least one is outside its brick's main component.
int64_t ComponentLinks::LinkFragments(BrickIndex n, Direction d, const BrickBits& main_plane) {
  const Sublattice sublattice = SublatticeAt(n);
  const BrickBits main = components_.MainPointsOf(n), own = components_.FragmentPointsOf(n);
  const BrickBits plane = NeighborPlane(d, sublattice, own, [&](int position) {
    return components_.FragmentPointsOf(NeighborAt(n, position));
  });
  BrickBits pairs;
  for (size_t k = 0; k < 8; ++k) {
    pairs.words[k] =
        (own.words[k] & (main_plane.words[k] | plane.words[k])) | (main.words[k] & plane.words[k]);
  }
  if (pairs.Empty()) return 0;
  int64_t joined = 0;
  for (const BrickContact& contact : ContactsAlong(sublattice, d)) {
    const BrickIndex other = NeighborAt(n, contact.position);
    Intersection(pairs, contact.points).ForEachSetBit([&](int bit) {
      joined += Unite(MemberOf(n, bit), MemberOf(other, NeighborBit(sublattice, d, bit)));
    });
  }
  return joined;
}

// A brick that is not stored is background all over.
int64_t ComponentLinks::LinkToGap(BrickIndex n, int position) {
  const BrickBits& contact = ContactWith(SublatticeAt(n), position);
  const size_t gap = gaps_->NodeAt(NeighborBrick(object_.keys()[n].coordinates(), position));
  int64_t joined = 0;
  if (Intersect(components_.MainPointsOf(n), contact)) joined += Unite(MainMember(n), gap);
  if (components_.fragments(n) == nullptr) return joined;
  Intersection(components_.FragmentPointsOf(n), contact).ForEachSetBit([&](int bit) {
    joined += Unite(MemberOf(n, bit), gap);
  });
  return joined;
}

}  // namespace bccskel
