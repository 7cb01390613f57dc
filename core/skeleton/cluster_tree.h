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

// The interior of a large cluster as nodes and the paths between them. With one node in the middle
// of a plate or a sponge, every edge would have a path of its own to the middle: the number of
// points of the cluster times its width. The paths of a tree share points.
class ClusterTree {
 public:
  // Shapes: parent(p) is a neighbor of p, nearer to the root; `terminals` are the points where
  //         edges start, each as often as edges start there.
  // Needs:  five terminals. Unless the root `stays`, it moves to where three paths or edges meet.
  ClusterTree(PointIndex root, const std::function<PointIndex(PointIndex)>& parent,
              std::span<const PointIndex> terminals, bool stays);

  PointIndex root() const { return root_; }
  // The nodes: the root, and the points where three or more paths and edges meet; increasing.
  std::vector<PointIndex> Nodes() const;
  // The path to a terminal from its nearest node, and to a node other than the root from the next
  // node toward the root.
  PointPath StemOf(PointIndex terminal) const;
  PointPath LimbOf(PointIndex node) const;

 private:
  struct Spot {
    PointIndex parent = 0;
    uint32_t fan = 0;  // number of paths that continue from here and edges that start here
  };

  bool IsNode(PointIndex p, const Spot& spot) const { return p == root_ || spot.fan > 1; }
  // Extends the path up to the next node, at most the root.
  PointPath UpToNode(PointPath path) const;
  void MoveRoot(std::span<const PointIndex> terminals);

  PointIndex root_;
  std::unordered_map<PointIndex, Spot> spots_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CLUSTER_TREE_H_
