#ifndef BCCSKEL_CORE_TOPOLOGY_SIMPLE_POINT_TABLE_H_
#define BCCSKEL_CORE_TOPOLOGY_SIMPLE_POINT_TABLE_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/lattice/directions.h"

namespace bccskel {

// Condition 1 for each of the 2^14 neighborhoods, one bit each: 2 KiB stay in the first-level cache
// beside a volume's bricks.
class SimplePointTable {
 public:
  static constexpr size_t kSize = size_t{1} << kNeighborCount;

  // The one table, filled on first use. Threads: safe.
  static const SimplePointTable& Get();

  // Needs: mask < kSize.
  bool IsSimple(NeighborMask mask) const { return ((words_[mask >> 6] >> (mask & 63)) & 1) != 0; }

 private:
  SimplePointTable();

  std::array<uint64_t, kSize / 64> words_ = {};
};

// Condition 1: one component of object and one of background neighbors (section 3).
inline bool IsSimple(NeighborMask mask) { return SimplePointTable::Get().IsSimple(mask); }

// Conditions 1 and 2: simple and more than one object neighbor.
inline bool IsSimpleNonEnd(NeighborMask mask) {
  return (mask & (mask - 1)) != 0 && SimplePointTable::Get().IsSimple(mask);
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_TOPOLOGY_SIMPLE_POINT_TABLE_H_
