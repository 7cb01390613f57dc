#include "core/thinning/direction_rule.h"

namespace bccskel {

DiagonalDirection DirectionRule::DirectionOf(const PassStep& at) const {
  const bool reversed = alternates_ && at.cycle % 2 == 1;
  return DiagonalDirection(reversed ? 7 - at.pass : at.pass);
}

DirtyMask DirectionRule::BitsToVisit(const PassStep& at) const {
  return static_cast<DirtyMask>(1u << DirectionOf(at).bit());
}

void DirectionRule::Mark(const PassStep& at, BrickLists& bricks, DirtyMask*, MarkBuffer& marks,
                         std::vector<MarkedBrick>& ends) {
  for (Sublattice sublattice : kSublattices) {
    const std::span<const BrickIndex> list = bricks.Of(sublattice);
    marks.Add(MarkRemovable(state_.View(), sublattice, DirectionOf(at), list,
                            marks.Room(list.size()), ends));
  }
}

}  // namespace bccskel
