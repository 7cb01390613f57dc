#ifndef BCCSKEL_CORE_EXPORT_RECONSTRUCT_OVERLAP_H_
#define BCCSKEL_CORE_EXPORT_RECONSTRUCT_OVERLAP_H_

#include <cstdint>

#include "core/volume/volume.h"

namespace bccskel {

// How much two objects have in common.
struct Overlap {
  uint64_t common = 0;  // points in both
  uint64_t all = 0;     // points in either

  // Jaccard's index: 1 for equal objects, 0 for disjoint ones; 1 for two empty ones.
  double Jaccard() const {
    return all == 0 ? 1 : static_cast<double>(common) / static_cast<double>(all);
  }
  friend bool operator==(const Overlap&, const Overlap&) = default;
};

// Compares lattice coordinates; placements are not looked at.
Overlap MeasureOverlap(const Volume& a, const Volume& b);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_EXPORT_RECONSTRUCT_OVERLAP_H_
