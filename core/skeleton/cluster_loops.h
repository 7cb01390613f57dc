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
// paths to the middle. Sorted by that.
struct Chord {
  uint32_t steps;
  PointIndex a;
  PointIndex b;
  friend auto operator<=>(const Chord&, const Chord&) = default;
};

// The loops that a cluster encloses: one chord for each loop of its topology. With the tree of
// shortest paths to the middle they make up all of them (a basis of its first homology group).
struct ClusterLoops {
  PointIndex at = 0;  // the middle: the root of the tree
  std::vector<Chord> chords;
};

// Finds the loops of one cluster after the other.
class ClusterLoopFinder {
 public:
  ClusterLoopFinder(const ThinPoints& points, const Clusters& clusters, StopPoll& poll);

  // Chords in order of length, then of points.
  // Needs: one of the clusters, with loops and without cavities, not asked for before.
  ClusterLoops Find(const Cluster& cluster);

  // Of a cluster that was asked for: whether the tree reaches p, and p's next point towards the
  // root.
  bool IsInTree(PointIndex p) const { return masks_[p] != 0; }
  PointIndex Parent(PointIndex p) const { return trees_.Parent(p); }
  // From the root along both paths and the chord.
  PointPath CloseLoop(const Chord& chord) const;

 private:
  std::vector<PointIndex> ThinToKernel(const Cluster& cluster);
  std::vector<Chord> FindChords(std::span<const PointIndex> kernel) const;
  std::vector<uint8_t> FindFreeChords(std::span<const PointIndex> kernel,
                                      std::span<const Chord> chords);

  const ThinPoints& points_;
  StopPoll& poll_;
  // By point, the neighbors left in its cluster's kernel; at first all those in its cluster.
  std::vector<NeighborMask> masks_;
  SpanningTrees trees_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CLUSTER_LOOPS_H_
