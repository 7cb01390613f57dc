#include "tests/support/reference_betti.h"

#include <vector>

#include "tests/support/reference_conditions.h"

namespace bccskel::test {
namespace {

enum class Side { kObject, kBackground };

// Components of the object, or of the background inside the padded box.
int64_t CountComponentsOf(const ReferencePointSet& object, Side side) {
  std::vector<bool> reached(object.box_size());
  std::vector<LatticePoint> open;
  const auto reach = [&](LatticePoint p) {
    if (!object.InBox(p) || reached[object.Index(p)]) return;
    if (object.Contains(p) != (side == Side::kObject)) return;
    reached[object.Index(p)] = true;
    open.push_back(p);
  };
  int64_t components = 0;
  object.ForEachLatticePointOfBox([&](LatticePoint start) {
    reach(start);
    if (open.empty()) return;
    ++components;
    while (!open.empty()) {
      const LatticePoint p = open.back();
      open.pop_back();
      for (LatticePoint offset : kDirections14) reach(p + offset);
    }
  });
  return components;
}

// Cliques of 1 to 4 points whose least point is p, odd sizes counted +1 and even ones -1.
int64_t SignedCliquesAt(const ReferencePointSet& object, LatticePoint p) {
  std::vector<LatticePoint> above;
  for (LatticePoint offset : kDirections14) {
    if (p < p + offset && object.Contains(p + offset)) above.push_back(p + offset);
  }
  int64_t sum = 1;
  for (size_t a = 0; a < above.size(); ++a) {
    sum -= 1;
    for (size_t b = 0; b < a; ++b) {
      if (!AreNeighbors(above[a], above[b])) continue;
      sum += 1;
      for (size_t c = 0; c < b; ++c) {
        if (AreNeighbors(above[a], above[c]) && AreNeighbors(above[b], above[c])) sum -= 1;
      }
    }
  }
  return sum;
}

}  // namespace

int64_t ReferenceEulerCharacteristic(const ReferencePointSet& object) {
  int64_t sum = 0;
  for (LatticePoint p : object.SortedPoints()) sum += SignedCliquesAt(object, p);
  return sum;
}

BettiNumbers ReferenceBetti(const ReferencePointSet& object) {
  BettiNumbers betti;
  betti.components = CountComponentsOf(object, Side::kObject);
  betti.cavities = CountComponentsOf(object, Side::kBackground) - 1;
  betti.loops = betti.components + betti.cavities - ReferenceEulerCharacteristic(object);
  return betti;
}

uint64_t ReferenceSimpleNonEndPoints(const ReferencePointSet& object) {
  uint64_t count = 0;
  for (LatticePoint p : object.SortedPoints()) {
    const NeighborMask mask = object.NeighborsOf(p);
    if (ReferenceCondition2(mask) && ReferenceCondition1(mask)) ++count;
  }
  return count;
}

}  // namespace bccskel::test
