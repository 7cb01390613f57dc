#include "core/skeleton/clusters.h"

#include <algorithm>

#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

bool HasPlainCurveMask(NeighborMask mask) { return IsCurvePoint(mask) && ComponentsIn(mask) == 2; }

}  // namespace

Clusters::Clusters(const ThinPoints& points, StopPoll& poll)
    : plain_(points.size()),
      inner_masks_(points.size()),
      collected_(points.size()),
      cluster_of_(points.size()) {
  Classify(points, poll);
  std::vector<NeighborMask> seen(points.size());
  for (PointIndex p = 0; p < points.size() && !poll.Stopped(); ++p) {
    if (IsPlainCurvePoint(p) || collected_[p] != 0) continue;
    Cluster cluster = Collect(points, p, poll);
    cluster.topology = MeasureCluster(points, cluster.points, inner_masks_, seen, poll);
    clusters_.push_back(std::move(cluster));
  }
}

// End points keep an empty inner mask, so an end beside a cluster, or two ends side by side, stay
// clusters of their own.
void Clusters::Classify(const ThinPoints& points, StopPoll& poll) {
  std::vector<uint8_t> is_single(points.size());
  for (PointIndex p = 0; p < points.size() && !poll.Stopped(); ++p) {
    plain_[p] = HasPlainCurveMask(points.mask(p)) ? 1 : 0;
    is_single[p] = plain_[p] != 0 || NeighborsIn(points.mask(p)) < 2 ? 1 : 0;
  }
  for (PointIndex p = 0; p < points.size() && !poll.Stopped(); ++p) {
    if (is_single[p] != 0) continue;
    ForEachDirection(points.mask(p), [&](Direction d) {
      if (is_single[points.Neighbor(p, d)] != 0) return;
      inner_masks_[p] = With(inner_masks_[p], d);
    });
  }
}

Cluster Clusters::Collect(const ThinPoints& points, PointIndex start, StopPoll& poll) {
  Cluster cluster;
  const auto add = [&](PointIndex p) {
    collected_[p] = 1;
    cluster_of_[p] = static_cast<ClusterIndex>(clusters_.size());
    cluster.points.push_back(p);
  };
  add(start);
  for (size_t n = 0; n < cluster.points.size() && !poll.Stopped(); ++n) {
    const PointIndex p = cluster.points[n];
    cluster.branches +=
        static_cast<uint32_t>(NeighborsIn(points.mask(p)) - NeighborsIn(inner_masks_[p]));
    ForEachDirection(inner_masks_[p], [&](Direction d) {
      const PointIndex q = points.Neighbor(p, d);
      if (collected_[q] == 0) add(q);
    });
  }
  if (poll.StoppedNow()) return cluster;
  std::ranges::sort(cluster.points);
  return cluster;
}

}  // namespace bccskel
