#include "core/thinning/cleanup.h"

#include <array>
#include <vector>

#include "core/exec/status_macros.h"
#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

struct Address {
  BrickIndex brick;
  int bit;
};

// Points that may be simple, by subfield. Removals only take neighbors away, so a point that is not
// among them at first never becomes one.
class PossiblySimplePoints {
 public:
  explicit PossiblySimplePoints(const ThinningState& state) {
    for (Sublattice sublattice : kSublattices) Collect(state, sublattice);
  }

  // Removes all points of one subfield that satisfy Conditions 1 and 2; returns how many.
  uint64_t RemoveSubfield(int color, ThinningState& state) {
    return std::erase_if(by_subfield_[static_cast<size_t>(color)], [&](const Address& p) {
      if (!IsSimpleNonEnd(state.NeighborsOf(p.brick, p.bit))) return false;
      state.object[p.brick].Clear(p.bit);
      return true;
    });
  }

 private:
  void Collect(const ThinningState& state, Sublattice sublattice) {
    std::vector<BrickIndex> bricks;
    for (BrickIndex n = 0; n < state.brick_count(); ++n) {
      if (state.SublatticeOf(n) == sublattice && !state.object[n].Empty()) bricks.push_back(n);
    }
    std::vector<MarkedBrick> marked(bricks.size());
    marked.resize(MarkPossiblySimple(state.View(), sublattice, bricks, marked.data()));
    for (const MarkedBrick& m : marked) {
      const BrickCoordinates brick = state.keys[m.brick].coordinates();
      m.marks.ForEachSetBit([&](int bit) {
        const LatticePoint p = PointOf(brick, bit);
        by_subfield_[static_cast<size_t>((p.x + p.y + p.z) & 3)].push_back({m.brick, bit});
      });
    }
  }

  std::array<std::vector<Address>, 4> by_subfield_;
};

}  // namespace

absl::StatusOr<uint64_t> CleanUpThinness(const exec::Context& context, ThinningState& state) {
  uint64_t total = 0;
  PossiblySimplePoints points(state);
  while (true) {
    BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
    uint64_t removed = 0;
    for (int color = 0; color < 4; ++color) removed += points.RemoveSubfield(color, state);
    if (removed == 0) return total;
    total += removed;
  }
}

}  // namespace bccskel
