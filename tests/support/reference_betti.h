#ifndef BCCSKEL_TESTS_SUPPORT_REFERENCE_BETTI_H_
#define BCCSKEL_TESTS_SUPPORT_REFERENCE_BETTI_H_

#include <cstdint>

#include "core/certificate/certificate.h"
#include "tests/support/reference_point_set.h"

namespace bccskel::test {

// Points - adjacent pairs + mutually adjacent triples - mutually adjacent quadruples, each counted
// by looking at it.
int64_t ReferenceEulerCharacteristic(const ReferencePointSet& object);

// Components by flood fill of the object, cavities by flood fill of the background in the padded
// box, loops from the Euler characteristic.
BettiNumbers ReferenceBetti(const ReferencePointSet& object);

// Points that are simple and not end points, by flood fill of their neighborhoods.
uint64_t ReferenceSimpleNonEndPoints(const ReferencePointSet& object);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_REFERENCE_BETTI_H_
