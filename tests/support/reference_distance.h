#ifndef BCCSKEL_TESTS_SUPPORT_REFERENCE_DISTANCE_H_
#define BCCSKEL_TESTS_SUPPORT_REFERENCE_DISTANCE_H_

#include <cstdint>
#include <vector>

#include "core/lattice/lattice_point.h"
#include "tests/support/reference_point_set.h"

namespace bccskel::test {

// Counts of a D8 and a D6 step: sqrt(3) and 2 lattice units (section 4) in fixed point.
inline constexpr uint32_t kReferenceDiagonal = 181;
inline constexpr uint32_t kReferenceAxial = 209;

// Chamfer distance to the background of each point of the set, in counts, by two raster scans over
// the box. Indexed by ReferencePointSet::Index(); 0 for background points.
// Needs: no distance of more than 627 lattice units.
std::vector<uint32_t> ReferenceChamfer(const ReferencePointSet& object);

// The shortest digital path between two points, in counts, by trying all mixtures of steps.
uint32_t ReferenceChamferBetween(LatticePoint a, LatticePoint b);

// The rounded distance in shells of the given width (lattice units), at least 1.
int32_t ReferenceShell(uint32_t counts, double shell_width);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_REFERENCE_DISTANCE_H_
