#include "core/topology/simple_point_table.h"

#include "core/topology/neighborhood.h"

namespace bccskel {

const SimplePointTable& SimplePointTable::Get() {
  static const SimplePointTable table;
  return table;
}

SimplePointTable::SimplePointTable() {
  for (size_t n = 0; n < kSize; ++n) {
    const auto object = static_cast<NeighborMask>(n);
    const auto background = static_cast<NeighborMask>(object ^ kAllNeighbors);
    if (ComponentsIn(object) == 1 && ComponentsIn(background) == 1) {
      words_[n >> 6] |= uint64_t{1} << (n & 63);
    }
  }
}

}  // namespace bccskel
