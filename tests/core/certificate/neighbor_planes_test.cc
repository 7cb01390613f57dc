#include "core/certificate/neighbor_planes.h"

#include <gtest/gtest.h>

#include "core/volume/brick_neighbors.h"
#include "core/volume/volume.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

TEST(NeighborPlanes, SayOfEachPointWhetherItsNeighborIsInTheObject) {
  const Volume object = VolumeOfPoints(test::RandomCloud(11, {40, 11, 21}, 0.4));
  const std::vector<BrickNeighborhood> neighbors = FindBrickNeighbors(object.keys());
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    const BrickCoordinates brick = object.keys()[n].coordinates();
    for (int d = 0; d < kNeighborCount; ++d) {
      const BrickBits plane =
          NeighborPlane(Direction(d), brick.sublattice, object.bricks()[n], [&](int position) {
            return object.padded_bricks()[neighbors[n][static_cast<size_t>(position)]];
          });
      for (int bit = 0; bit < kBrickPoints; ++bit) {
        const LatticePoint p = PointOf(brick, bit) + Direction(d).offset();
        ASSERT_EQ(plane.Test(bit), object.Contains(p)) << "brick " << n << " d " << d;
      }
    }
  }
}

}  // namespace
}  // namespace bccskel
