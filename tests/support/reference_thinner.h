#ifndef BCCSKEL_TESTS_SUPPORT_REFERENCE_THINNER_H_
#define BCCSKEL_TESTS_SUPPORT_REFERENCE_THINNER_H_

#include <cstdint>
#include <vector>

#include "core/lattice/lattice_point.h"
#include "core/thinning/thinning.h"
#include "core/volume/volume.h"

namespace bccskel::test {

struct ReferenceThinning {
  std::vector<LatticePoint> thin;       // in lattice order
  std::vector<IsthmusBirth> isthmuses;  // in lattice order
  int32_t last_shell = 0;               // the deepest shell of the object
  uint64_t removed = 0;                 // by passes and stubble removal
  uint64_t removed_by_cleanup = 0;
  uint32_t passes = 0;
};

// The thinning of section 5, point by point as the paper words it, with the reading of its open
// places that the README gives: one cycle of eight directions per shell, marks made on a frozen
// snapshot, the last shell's cycles repeated until a whole cycle removes nothing, then the clean-up
// by four subfields. With the symmetric method a cycle is one pass of rule B.
// Cost: about 100 ns per candidate and pass, one byte per integer coordinate of the bounding box.
ReferenceThinning ReferenceThinCounted(const Volume& object, const ThinningOptions& options);

// Its points alone.
std::vector<LatticePoint> ReferenceThin(const Volume& object, const ThinningOptions& options);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_REFERENCE_THINNER_H_
