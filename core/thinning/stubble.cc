#include "core/thinning/stubble.h"

#include <bit>

#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

// The number of end points among the neighbors of a point that come before direction `before`.
int EndPointsBefore(const ThinningState& state, const NeighborAddress& q, NeighborMask neighbors,
                    Direction before) {
  int count = 0;
  for (int n = 0; n < before.bit(); ++n) {
    const Direction d(n);
    if ((neighbors & d.mask()) == 0) continue;
    const NeighborAddress e = NeighborAt(state, q.brick, q.bit, d);
    if (IsEndPoint(state.NeighborsOf(e.brick, e.bit))) ++count;
  }
  return count;
}

enum class EndKind : uint8_t { kStays, kStubble, kKept };

// Needs: the point is an end point.
EndKind Judge(const ThinningState& state, BrickIndex brick, int bit, StubblePolicy policy) {
  const Direction to_neighbor(std::countr_zero(state.NeighborsOf(brick, bit)));
  const NeighborAddress q = NeighborAt(state, brick, bit, to_neighbor);
  const NeighborMask around_q = state.NeighborsOf(q.brick, q.bit);
  const int neighbors = NeighborsIn(around_q);
  if (neighbors <= 2) return EndKind::kStays;
  if (policy == StubblePolicy::kLiteral) return EndKind::kStubble;
  const int before = EndPointsBefore(state, q, around_q, to_neighbor.Opposite());
  return before < neighbors - 2 ? EndKind::kStubble : EndKind::kKept;
}

}  // namespace

JudgedEnds JudgeEnds(const ThinningState& state, const MarkedBrick& end_points,
                     StubblePolicy policy) {
  JudgedEnds judged;
  end_points.marks.ForEachSetBit([&](int bit) {
    const EndKind kind = Judge(state, end_points.brick, bit, policy);
    if (kind == EndKind::kStubble) judged.stubble.Set(bit);
    if (kind == EndKind::kStays) judged.stay.Set(bit);
  });
  return judged;
}

}  // namespace bccskel
