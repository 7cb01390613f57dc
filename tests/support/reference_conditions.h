#ifndef BCCSKEL_TESTS_SUPPORT_REFERENCE_CONDITIONS_H_
#define BCCSKEL_TESTS_SUPPORT_REFERENCE_CONDITIONS_H_

#include <cstdint>
#include <span>

#include "core/lattice/directions.h"
#include "core/lattice/lattice_point.h"
#include "tests/support/reference_point_set.h"

// The conditions of sections 3 and 4, written from the paper's words with flood fills and the plane
// definition of the checking rings. Nothing of core/topology is used: these are its oracle.

namespace bccskel::test {

// Section 2: |dx| + |dy| + |dz| is 2 or 3, and the offset is on the lattice.
bool AreNeighbors(LatticePoint p, LatticePoint q);

// C(Q): maximal connected components of a finite set.
int CountComponents(std::span<const LatticePoint> points);

// Conditions 1 to 4 of a point p with its neighbors, and the directed border point of section 2.
// A mask stands for N14(p) and O.
bool ReferenceCondition1(NeighborMask mask);
bool ReferenceCondition2(NeighborMask mask);
bool ReferenceCondition3(NeighborMask mask, DiagonalDirection d);
bool ReferenceCondition4(NeighborMask mask, DiagonalDirection d);
bool ReferenceIsBorderPoint(NeighborMask mask, DiagonalDirection d);
// The border point and Conditions 1 to 4 together; all directions in which they hold, as bits 0..7.
// Computed for all neighborhoods on the first call.
bool ReferenceIsRemovable(NeighborMask mask, DiagonalDirection d);
uint8_t ReferenceRemovableDirections(NeighborMask mask);

// What p is to its surroundings, by components of object and background among its neighbors: a
// 1-isthmus has at least two of the object and one of the background, a 2-isthmus one of the object
// and at least two of the background.
bool ReferenceIsOneIsthmus(NeighborMask mask);
bool ReferenceIsTwoIsthmus(NeighborMask mask);

// R(p, axial, diagonal) for p = 0, as neighbors: every p + lambda * d1 + mu * d2 that is in N14(p).
NeighborMask ReferenceCheckingRing(LatticePoint axial, LatticePoint diagonal);

// Condition 6 of an end point p, as the paper writes it.
bool ReferenceIsStubble(const ReferencePointSet& object, LatticePoint p);
// The same, but of the end points at one neighbor q only so many that q keeps two neighbors: those
// of lowest rank in the order of kDirections14 around q.
bool ReferenceIsStubbleKeepTwo(const ReferencePointSet& object, LatticePoint p);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_REFERENCE_CONDITIONS_H_
