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

// The loops that a cluster encloses: closed paths through its points, one for each loop of its
// topology, that together make up all of them (a basis of its first homology group).
struct ClusterLoops {
  PointIndex at = 0;             // first and last point of every path
  std::vector<PointPath> paths;  // in order of length, then of points
};

// Finds the loops of one cluster after the other.
class ClusterLoopFinder {
 public:
  ClusterLoopFinder(const ThinPoints& points, const Clusters& clusters, StopPoll& poll);

  // Needs: one of the clusters, with loops and without cavities, not asked for before.
  ClusterLoops Find(const Cluster& cluster);

 private:
  // An edge of a kernel outside its tree, a < b. Sorted by the length of the loop that it closes.
  struct Chord {
    uint32_t steps;
    PointIndex a;
    PointIndex b;
    friend auto operator<=>(const Chord&, const Chord&) = default;
  };

  std::vector<PointIndex> ThinToKernel(const Cluster& cluster);
  void Remove(PointIndex p);
  std::vector<Chord> FindChords(std::span<const PointIndex> kernel) const;
  std::vector<uint8_t> FindFreeChords(std::span<const PointIndex> kernel,
                                      std::span<const Chord> chords);
  PointPath CloseLoop(const Chord& chord) const;

  const ThinPoints& points_;
  StopPoll& poll_;
  // By point, the neighbors left in its cluster's kernel; at first all those in its cluster.
  std::vector<NeighborMask> masks_;
  SpanningTrees trees_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CLUSTER_LOOPS_H_
