#ifndef BCCSKEL_CORE_SKELETON_CLUSTER_TREE_H_
#define BCCSKEL_CORE_SKELETON_CLUSTER_TREE_H_

#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/skeleton/spanning_trees.h"
#include "core/skeleton/thin_points.h"

namespace bccskel {

// The inside of a large cluster as nodes and the paths between them. With one node in the middle of
// a plate or a sponge, every edge would have a path of its own to there: as many points as the
// cluster has, times its width. Paths of a tree share them.
class ClusterTree {
 public:
  // Shapes: parent(p) is a neighbor of p, nearer to the root; `terminals` are the points where
  // edges
  //         start, each as often as edges do.
  // Needs:  five terminals. Unless the root `stays`, it moves to where three paths or edges meet.
  ClusterTree(PointIndex root, const std::function<PointIndex(PointIndex)>& parent,
              std::span<const PointIndex> terminals, bool stays);

  PointIndex root() const { return root_; }
  // The root, and where three or more paths and edges meet, increasing.
  std::vector<PointIndex> Nodes() const;
  // From the node next to a terminal, or to a node that is not the root, to that point.
  PointPath StemOf(PointIndex terminal) const;
  PointPath LimbOf(PointIndex node) const;

 private:
  struct Spot {
    PointIndex parent = 0;
    uint32_t fan = 0;  // paths that go on from here, and edges that start here
  };

  bool IsNode(PointIndex p, const Spot& spot) const { return p == root_ || spot.fan > 1; }
  // From above `p` on, at most to the root.
  PointPath UpToNode(PointPath path) const;
  void MoveRoot(std::span<const PointIndex> terminals);

  PointIndex root_;
  std::unordered_map<PointIndex, Spot> spots_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CLUSTER_TREE_H_
