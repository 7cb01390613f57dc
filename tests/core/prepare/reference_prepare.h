#ifndef BCCSKEL_TESTS_CORE_PREPARE_REFERENCE_PREPARE_H_
#define BCCSKEL_TESTS_CORE_PREPARE_REFERENCE_PREPARE_H_

#include <span>
#include <vector>

#include "core/lattice/lattice_point.h"

// Slow and plain, point by point and by flood fill: the oracle of core/prepare.

namespace bccskel::test {

// Sorted point lists in and out.
using Points = std::vector<LatticePoint>;

Points Sorted(Points points);
// Everything that a flood from outside the bounding box does not reach.
Points ReferenceFilled(const Points& points);
// In the order of their first points in `points`, each sorted.
std::vector<Points> ReferenceComponents(const Points& points);
// One pass of the majority over all points of the lattice around.
Points ReferenceDenoised(const Points& points);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_PREPARE_REFERENCE_PREPARE_H_
