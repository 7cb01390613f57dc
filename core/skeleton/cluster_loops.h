#ifndef BCCSKEL_CORE_SKELETON_CLUSTER_LOOPS_H_
#define BCCSKEL_CORE_SKELETON_CLUSTER_LOOPS_H_

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "core/exec/stop_poll.h"
#include "core/skeleton/clusters.h"
#include "core/skeleton/spanning_trees.h"
#include "core/skeleton/thin_points.h"

namespace bccskel {

// An edge between two points of a cluster, a < b, that closes a loop of `steps` steps with their
// paths to the middle. Sorted in this order.
struct Chord {
  uint32_t steps;
  PointIndex a;
  PointIndex b;
  friend auto operator<=>(const Chord&, const Chord&) = default;
};

// The loops that a cluster encloses: one chord per loop of its topology. Together with the tree of
// shortest paths to the middle, the chords give a basis of its first homology group.
struct ClusterLoops {
  PointIndex at = 0;  // the middle: the root of the tree
  std::vector<Chord> chords;
};

// Finds the loops of clusters, one cluster at a time.
class ClusterLoopFinder {
 public:
  ClusterLoopFinder(const ThinPoints& points, const Clusters& clusters, StopPoll& poll);

  // Returns chords ordered by length, then points.
  // Needs: one of the clusters, with loops and without cavities, not passed before.
  ClusterLoops Find(const Cluster& cluster);

  // For a cluster passed to Find(): whether the tree reaches p, and the next point from p towards
  // the root.
  bool IsInTree(PointIndex p) const { return masks_[p] != 0; }
  PointIndex Parent(PointIndex p) const { return trees_.Parent(p); }
  // The loop from the root along both paths and the chord.
  PointPath CloseLoop(const Chord& chord) const;

 private:
  std::vector<PointIndex> ThinToKernel(const Cluster& cluster);
  std::vector<Chord> FindChords(std::span<const PointIndex> kernel) const;
  std::vector<uint8_t> FindFreeChords(std::span<const PointIndex> kernel,
                                      std::span<const Chord> chords);

  const ThinPoints& points_;
  StopPoll& poll_;
  // By point, the remaining neighbors in its cluster's kernel; initially all those in its cluster.
  std::vector<NeighborMask> masks_;
  SpanningTrees trees_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CLUSTER_LOOPS_H_
