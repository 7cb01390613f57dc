#ifndef BCCSKEL_TESTS_QUALITY_HAIR_H_
#define BCCSKEL_TESTS_QUALITY_HAIR_H_

#include "core/skeleton/skeleton_graph.h"
#include "tests/quality/voxel_mask.h"

// What is wrong with the skeleton of an object whose true tips nobody knows.

namespace bccskel::quality {

struct Hair {
  // End branches shorter, from where they leave the ball of their junction, than their radius is
  // there.
  int twigs = 0;
  // The share of the skeleton's length that lies inside 0.9 of the largest ball of a point of
  // another edge, to which the way along the graph is longer than two radii of that ball: strands,
  // ribs, doubled curves. Edges that no cut of ends can take do not count: they belong to loops of
  // the object.
  double redundant_length = 0;
};
Hair HairOf(const SkeletonGraph& graph);

// Connected groups of more than 20 voxels of the mask that lie more than 4 voxels outside all balls
// of the skeleton's points. Needs: the graph and the mask lie in one world.
int CountMissedParts(const SkeletonGraph& graph, const VoxelMask& mask);

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_HAIR_H_
