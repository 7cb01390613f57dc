#include "core/lattice/directions.h"

namespace bccskel {
namespace {

constexpr bool AllOnLatticeAndDistinct() {
  for (int a = 0; a < kNeighborCount; ++a) {
    if (!IsOnLattice(Direction(a).offset())) return false;
    for (int b = 0; b < a; ++b) {
      if (Direction(a).offset() == Direction(b).offset()) return false;
    }
  }
  return true;
}
static_assert(AllOnLatticeAndDistinct());
static_assert(FindDirection({1, 1, 1})->bit() == 7 && FindDirection({0, 0, -2})->bit() == 13);
static_assert(!FindDirection({1, 1, 0}));

}  // namespace
}  // namespace bccskel
