#ifndef BCCSKEL_CORE_SKELETON_CLUSTER_LOOPS_H_
#define BCCSKEL_CORE_SKELETON_CLUSTER_LOOPS_H_

#include <compare>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/exec/stop_poll.h"
#include "core/skeleton/clusters.h"
#include "core/skeleton/spanning_trees.h"
#include "core/skeleton/thin_points.h"

namespace bccskel {

// The loops that a cluster encloses: closed paths through its points, one for each loop of its
// topology, that together make up all of them (a basis of its first homology group). All paths
// start at one point, so those of a large sponge would be longer the larger it is: the longest are
// only counted where paths would have more than kPathPointsPerPoint points for each of the cluster.
struct ClusterLoops {
  PointIndex at = 0;          // first and last point of every path
  uint32_t without_path = 0;  // loops beside those of the paths
};
inline constexpr size_t kPathPointsPerPoint = 64;

// Finds the loops of one cluster after the other.
class ClusterLoopFinder {
 public:
  ClusterLoopFinder(const ThinPoints& points, const Clusters& clusters, StopPoll& poll);

  // Calls add(path) for each path, in order of length, then of points, as long as it says true.
  // Needs: one of the clusters, with loops and without cavities, not asked for before.
  ClusterLoops Find(const Cluster& cluster, const std::function<bool(PointPath)>& add);

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
