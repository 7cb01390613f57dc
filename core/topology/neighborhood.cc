#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

constexpr int CountAdjacentPairs() {
  int ends = 0;
  for (NeighborMask shared : kSharedNeighbors) ends += NeighborsIn(shared);
  return ends / 2;
}
static_assert(CountAdjacentPairs() == 36);
static_assert(NeighborsIn(NeighborsAmongN14(Direction(0))) == 6);
static_assert(NeighborsIn(NeighborsAmongN14(Direction(8))) == 4);
static_assert(ComponentsIn(0) == 0 && ComponentsIn(kAllNeighbors) == 1);
static_assert(ComponentsIn(Direction(0).mask() | Direction(7).mask()) == 2);

}  // namespace
}  // namespace bccskel
