#ifndef BCCSKEL_TESTS_SUPPORT_REFERENCE_CLIQUES_H_
#define BCCSKEL_TESTS_SUPPORT_REFERENCE_CLIQUES_H_

#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <vector>

#include "core/lattice/lattice_point.h"
#include "tests/support/reference_point_set.h"

// The clique rule of symmetric thinning, written from its words: cliques are enumerated one by one
// and links are looked at point by point.

namespace bccskel::test {

// Whether the object points adjacent to every point of a clique (of 2, 3 or 4 mutually adjacent
// object points) are contractible. If not, the clique is critical.
bool HasContractibleLink(const ReferencePointSet& object, std::span<const LatticePoint> clique);

// Which of a clique's points stays is the one with the largest value; within a clique no two values
// may be equal.
using Priority = std::function<int64_t(LatticePoint)>;

// Rule B. In order pairs, triples, tetrahedra: from every critical clique that still lies in
// `simple` the point of highest priority is taken out, for all cliques of one size at once.
// Returns: what is left of `simple`; all of it may be deleted together.
std::set<LatticePoint> ReferenceRuleB(const ReferencePointSet& object,
                                      std::set<LatticePoint> simple, const Priority& priority);

// Rule C: the same with all three sizes at once.
std::set<LatticePoint> ReferenceRuleC(const ReferencePointSet& object,
                                      std::set<LatticePoint> simple, const Priority& priority);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_REFERENCE_CLIQUES_H_
