#include "tests/support/reference_cliques.h"

#include <algorithm>

#include "tests/support/reference_conditions.h"

namespace bccskel::test {
namespace {

using Clique = std::vector<LatticePoint>;

bool AdjacentToAll(LatticePoint q, std::span<const LatticePoint> clique) {
  return std::ranges::all_of(clique, [&](LatticePoint p) { return AreNeighbors(p, q); });
}

// Calls visit(clique) for each clique of `size` points of `among` that starts with the given ones.
// A clique is visited once, its points in increasing order.
template <typename Visit>
void ForEachClique(const std::set<LatticePoint>& among, Clique& clique, size_t size, Visit visit) {
  if (clique.size() == size) return visit(clique);
  const LatticePoint first = clique.front(), last = clique.back();
  for (LatticePoint offset : kDirections14) {
    const LatticePoint q = first + offset;
    if (!(last < q) || !among.contains(q) || !AdjacentToAll(q, clique)) continue;
    clique.push_back(q);
    ForEachClique(among, clique, size, visit);
    clique.pop_back();
  }
}

// The points that critical cliques of one size send back.
std::set<LatticePoint> TakenOut(const ReferencePointSet& object,
                                const std::set<LatticePoint>& simple, size_t size,
                                const Priority& priority) {
  std::set<LatticePoint> taken;
  for (LatticePoint p : simple) {
    Clique start = {p};
    ForEachClique(simple, start, size, [&](const Clique& clique) {
      if (HasContractibleLink(object, clique)) return;
      taken.insert(*std::ranges::max_element(clique, {}, priority));
    });
  }
  return taken;
}

void Subtract(const std::set<LatticePoint>& taken, std::set<LatticePoint>& from) {
  for (LatticePoint p : taken) from.erase(p);
}

}  // namespace

bool HasContractibleLink(const ReferencePointSet& object, std::span<const LatticePoint> clique) {
  std::vector<LatticePoint> common, link;
  for (LatticePoint offset : kDirections14) {
    const LatticePoint q = clique.front() + offset;
    if (!AdjacentToAll(q, clique)) continue;
    common.push_back(q);
    if (object.Contains(q)) link.push_back(q);
  }
  // Around a pair the common neighbors form a cycle: a part of it is contractible iff it is one
  // arc. A triple has two of them, which are not adjacent; a quadruple none.
  return !link.empty() && link.size() < common.size() && CountComponents(link) == 1;
}

std::set<LatticePoint> ReferenceRuleB(const ReferencePointSet& object,
                                      std::set<LatticePoint> simple, const Priority& priority) {
  for (const size_t size : {2U, 3U, 4U}) Subtract(TakenOut(object, simple, size, priority), simple);
  return simple;
}

std::set<LatticePoint> ReferenceRuleC(const ReferencePointSet& object,
                                      std::set<LatticePoint> simple, const Priority& priority) {
  std::set<LatticePoint> taken;
  for (const size_t size : {2U, 3U, 4U}) taken.merge(TakenOut(object, simple, size, priority));
  Subtract(taken, simple);
  return simple;
}

}  // namespace bccskel::test
