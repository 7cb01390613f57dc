#ifndef BCCSKEL_TESTS_CORE_PREPARE_REFERENCE_PREPARE_H_
#define BCCSKEL_TESTS_CORE_PREPARE_REFERENCE_PREPARE_H_

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/certificate/certificate.h"
#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"

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

using IsIn = std::function<bool(double x, double y, double z)>;
BettiNumbers BettiOf(const Volume& object);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_PREPARE_REFERENCE_PREPARE_H_
