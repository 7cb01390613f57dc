#include "core/pruning/persistence.h"

#include <algorithm>

namespace bccskel {
namespace {

// The birth at which a point needs twice as many passes as one born in the first pass.
constexpr double kDeepBirth = 20;

}  // namespace

double PersistenceOf(const ThinSet& set, const FreeBranch& branch) {
  double persistence = 0;
  int32_t death = 0;
  for (LatticePoint p : branch.points) {
    const int32_t birth = set.BirthOf(p);
    death = std::max(death, birth) + 1;
    persistence = std::max(persistence, (death - birth) / (1 + birth / kDeepBirth));
  }
  return persistence;
}

}  // namespace bccskel
