#ifndef BCCSKEL_CORE_SKELETON_CLUSTERS_H_
#define BCCSKEL_CORE_SKELETON_CLUSTERS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/exec/stop_poll.h"
#include "core/skeleton/thin_points.h"

namespace bccskel {

// Position of a cluster in Clusters.
using ClusterIndex = uint32_t;

// A cluster of points; end points and isolated points are clusters of one point.
struct Cluster {
  std::vector<PointIndex> points;  // increasing
  uint32_t loops = 0;              // that it encloses, and cavities
  uint32_t cavities = 0;
  uint32_t branches = 0;  // pairs of neighbors, one inside the cluster and one outside

  bool IsContractible() const { return loops == 0 && cavities == 0; }
  // A thick spot inside one branch. It is not a node of the graph.
  bool IsBend() const { return IsContractible() && branches == 2; }
};

// Splits the points into plain curve points and clusters.
//
// A plain curve point has two neighbors, which are not adjacent to each other; an end point has
// one. So three mutually adjacent points contain neither. The clique complex of the volume
// therefore consists of those of the clusters and of chains of edges, each attached at single
// points. Its components and loops are those of the graph that has a node for each cluster, plus
// the loops and cavities of the clusters themselves. This holds for any volume, thin or not.
class Clusters {
 public:
  // Incomplete if `poll` requests a stop.
  Clusters(const ThinPoints& points, StopPoll& poll);

  size_t size() const { return clusters_.size(); }
  const Cluster& operator[](ClusterIndex c) const { return clusters_[c]; }
  bool IsPlainCurvePoint(PointIndex p) const { return plain_[p] != 0; }
  // Needs: not a plain curve point.
  ClusterIndex ClusterOf(PointIndex p) const { return cluster_of_[p]; }
  // The neighbors of p in p's own cluster, by point; 0 for plain curve points.
  std::span<const NeighborMask> inner_masks() const { return inner_masks_; }

 private:
  void Classify(const ThinPoints& points, StopPoll& poll);
  Cluster Collect(const ThinPoints& points, PointIndex start, StopPoll& poll);

  std::vector<uint8_t> plain_;
  std::vector<NeighborMask> inner_masks_;
  std::vector<uint8_t> collected_;
  std::vector<ClusterIndex> cluster_of_;
  std::vector<Cluster> clusters_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CLUSTERS_H_
