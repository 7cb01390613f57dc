#include "core/certificate/brick_contacts.h"

#include <gtest/gtest.h>

#include "core/volume/brick_neighbors.h"

namespace bccskel {
namespace {

// Position 8..13 and 0..7 of the brick that holds p, seen from `brick`; -1 for the brick itself.
int PositionOf(BrickCoordinates brick, LatticePoint p) {
  for (int position = 0; position < kNeighborCount; ++position) {
    if (AddressOf(p).brick == NeighborBrick(brick, position)) return position;
  }
  return -1;
}

const BrickBits& PointsAt(Sublattice sublattice, int position) {
  return ContactsOf(sublattice).points_at[static_cast<size_t>(position)];
}

TEST(BrickContacts, HoldEachPointOnceForEachDirectionThatLeavesTheBrick) {
  for (Sublattice sublattice : kSublattices) {
    const BrickCoordinates brick = {3, 5, 2, sublattice};
    for (int d = 0; d < kNeighborCount; ++d) {
      for (int bit = 0; bit < kBrickPoints; ++bit) {
        const LatticePoint p = PointOf(brick, bit) + Direction(d).offset();
        const int position = PositionOf(brick, p);
        int found = 0;
        for (const BrickContact& contact : ContactsOf(sublattice).along[static_cast<size_t>(d)]) {
          if (!contact.points.Test(bit)) continue;
          EXPECT_EQ(contact.position, position);
          EXPECT_TRUE(PointsAt(sublattice, position).Test(bit));
          ++found;
        }
        EXPECT_EQ(found, position < 0 ? 0 : 1);
        EXPECT_EQ(NeighborBit(sublattice, Direction(d), bit), AddressOf(p).bit);
      }
    }
  }
}

TEST(BrickContacts, CountThePointsThatTouchEachNeighboringBrick) {
  for (Sublattice sublattice : kSublattices) {
    EXPECT_EQ(PointsAt(sublattice, 0).Count(), 512u);       // same cells, other sublattice
    EXPECT_EQ(PointsAt(sublattice, 7).Count(), 1u);         // across the corner
    EXPECT_EQ(PointsAt(sublattice, 1).Count(), 4u * 8u);    // across the x face
    EXPECT_EQ(PointsAt(sublattice, 13).Count(), 16u * 4u);  // along -z
  }
}

TEST(BrickContacts, NameThePositionsWhoseBricksTouchEachOther) {
  for (Sublattice sublattice : kSublattices) {
    const BrickCoordinates brick = {3, 5, 2, sublattice};
    for (int a = 0; a < kNeighborCount; ++a) {
      for (int b = 0; b < kNeighborCount; ++b) {
        bool touch = false;
        for (int bit = 0; bit < kBrickPoints && !touch; ++bit) {
          for (LatticePoint offset : kDirections14) {
            const LatticePoint p = PointOf(NeighborBrick(brick, a), bit) + offset;
            touch = touch || AddressOf(p).brick == NeighborBrick(brick, b);
          }
        }
        const PositionMask beside = ContactsOf(sublattice).beside[static_cast<size_t>(a)];
        EXPECT_EQ((beside >> b & 1) != 0, touch && a != b) << a << " and " << b;
      }
    }
  }
}

}  // namespace
}  // namespace bccskel
