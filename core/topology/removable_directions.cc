#include "core/topology/removable_directions.h"

#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

static_assert(ImplicationsOf(DiagonalDirection(7)) ==
              std::array<Implication, 6>{
                  {{*FindDirection({1, -1, -1}), *FindDirection({2, 0, 0})},
                   {*FindDirection({-1, 1, -1}), *FindDirection({0, 2, 0})},
                   {*FindDirection({-1, -1, 1}), *FindDirection({0, 0, 2})},
                   {*FindDirection({-2, 0, 0}), *FindDirection({-1, 1, 1})},
                   {*FindDirection({0, -2, 0}), *FindDirection({1, -1, 1})},
                   {*FindDirection({0, 0, -2}), *FindDirection({1, 1, -1})}}});

// The conditions exactly as in section 3.
bool MeetsConditions1To4(NeighborMask mask, DiagonalDirection d) {
  return IsDirectedBorderPoint(mask, d) && IsSimpleNonEnd(mask) &&
         SatisfiesCheckingRings(mask, d) && HasSequelPoint(mask, d);
}

class RemovableTable {
 public:
  RemovableTable() {
    for (size_t n = 0; n < directions_.size(); ++n) {
      for (int d = 0; d < 8; ++d) {
        if (!MeetsConditions1To4(static_cast<NeighborMask>(n), DiagonalDirection(d))) continue;
        directions_[n] = static_cast<uint8_t>(directions_[n] | 1 << d);
      }
    }
  }
  uint8_t operator[](NeighborMask mask) const { return directions_[mask]; }

 private:
  std::array<uint8_t, SimplePointTable::kSize> directions_ = {};
};

}  // namespace

uint8_t RemovableDirections(NeighborMask mask) {
  static const RemovableTable table;
  return table[mask];
}

}  // namespace bccskel
