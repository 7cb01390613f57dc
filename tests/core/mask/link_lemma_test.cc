// The steps of the proof in core/mask/README.md, in all their situations: a corner that is the
// lower end of a bad edge is simple at its turn, whatever went before.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/lattice/directions.h"
#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

// The corner lies at the origin, its bad edge points up along z. So the four voxels above are
// empty, and bit x + 2 y says which of those below, at (2x - 1, 2y - 1, -1), are in the object.
struct Situation {
  unsigned voxels = 0;  // not 0: the corner touches the object
  bool below = false;   // whether the corner below is still there
  unsigned beside = 0;  // which of the corners at +x, -x, +y, -y are
};

constexpr std::array<LatticePoint, 4> kVoxels = {
    {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1}}};
constexpr std::array<LatticePoint, 4> kBeside = {{{2, 0, 0}, {-2, 0, 0}, {0, 2, 0}, {0, -2, 0}}};

NeighborMask BitOf(LatticePoint offset) { return FindDirection(offset)->mask(); }

// The neighbors in the complex: a bad edge is none of its edges. One that leads to a corner beside
// is good where one of the two voxels below it is in the object.
NeighborMask LinkOf(const Situation& s) {
  unsigned link = s.below ? BitOf({0, 0, -2}) : 0u;
  for (size_t v = 0; v < kVoxels.size(); ++v) {
    if ((s.voxels >> v & 1) == 0) continue;
    link |= BitOf(kVoxels[v]);
    for (size_t b = 0; b < kBeside.size(); ++b) {
      if ((s.beside >> b & 1) != 0 && Dot(kVoxels[v], kBeside[b]) > 0) link |= BitOf(kBeside[b]);
    }
  }
  return static_cast<NeighborMask>(link);
}

// One voxel, two that share a face, or three.
bool IsArc(unsigned voxels) {
  constexpr std::array<unsigned, 3> kNone = {0b1001, 0b0110, 0b1111};  // the diagonals, all
  return std::ranges::find(kNone, voxels) == kNone.end();
}

TEST(LinkLemma, ACornerIsSimpleWhereTheOneBelowIsThereOrItsVoxelsAreAnArc) {
  for (unsigned voxels = 1; voxels < 16; ++voxels) {
    for (unsigned beside = 0; beside < 16; ++beside) {
      for (bool below : {false, true}) {
        const Situation s = {voxels, below, beside};
        EXPECT_EQ(IsSimple(LinkOf(s)), below || IsArc(voxels))
            << voxels << " " << below << " " << beside;
      }
    }
  }
}

// Where the voxels are no arc, the corner below is not the lower end of a bad edge, so it never
// goes: each edge around it has one of the voxels beside it.
TEST(LinkLemma, TheCornerBelowStaysWhereItIsNeeded) {
  for (unsigned voxels = 1; voxels < 16; ++voxels) {
    if (IsArc(voxels)) continue;
    for (LatticePoint edge : kBeside) {
      bool good = false;
      for (size_t v = 0; v < kVoxels.size(); ++v) {
        good |= (voxels >> v & 1) != 0 && Dot(kVoxels[v], edge) > 0;
      }
      EXPECT_TRUE(good) << voxels;
    }
  }
}

}  // namespace
}  // namespace bccskel
