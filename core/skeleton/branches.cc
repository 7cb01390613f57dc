#include "core/skeleton/branches.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace bccskel {
namespace {

// Follows plain curve points: single arcs, which run from cluster to cluster, bends included.
class ArcWalk {
 public:
  ArcWalk(const ThinPoints& points, const Clusters& clusters, StopPoll& poll)
      : points_(points), clusters_(clusters), poll_(poll), visited_(points.size()) {}

  std::vector<Branch> ArcsBetweenClusters() {
    std::vector<Branch> arcs;
    for (ClusterIndex c = 0; c < clusters_.size() && !poll_.Stopped(); ++c) {
      for (PointIndex p : clusters_[c].points) {
        const unsigned outward = points_.mask(p) & ~unsigned{clusters_.inner_masks()[p]};
        ForEachDirection(static_cast<NeighborMask>(outward), [&](Direction d) {
          PointPath path = WalkFrom(p, points_.Neighbor(p, d));
          if (!IsSecondWalk(path)) {
            arcs.push_back({c, clusters_.ClusterOf(path.back()), std::move(path)});
          }
        });
      }
    }
    return arcs;
  }

  // Needs: ArcsBetweenClusters() has been called.
  std::vector<PointPath> ClosedCurves() {
    std::vector<PointPath> curves;
    for (PointIndex p = 0; p < points_.size() && !poll_.Stopped(); ++p) {
      if (!clusters_.IsPlainCurvePoint(p) || visited_[p] != 0) continue;
      curves.push_back(WalkFrom(p, points_.BothNeighbors(p)[0]));
    }
    return curves;
  }

 private:
  // From `start` by way of its neighbor `next` to the next point of a cluster, or back to `start`.
  PointPath WalkFrom(PointIndex start, PointIndex next) {
    PointPath path = {start, next};
    while (clusters_.IsPlainCurvePoint(path.back()) && path.back() != start && !poll_.Stopped()) {
      visited_[path.back()] = 1;
      const std::array<PointIndex, 2> ways = points_.BothNeighbors(path.back());
      path.push_back(ways[0] == path[path.size() - 2] ? ways[1] : ways[0]);
    }
    visited_[path.back()] = 1;
    return path;
  }

  // Every arc is walked from both ends.
  static bool IsSecondWalk(const PointPath& path) {
    return std::pair{path.back(), path[path.size() - 2]} < std::pair{path[0], path[1]};
  }

  const ThinPoints& points_;
  const Clusters& clusters_;
  StopPoll& poll_;
  std::vector<uint8_t> visited_;
};

enum class ArcSide : uint8_t { kSource, kTarget };

struct ArcEnd {
  size_t arc;
  ArcSide side;
  friend bool operator==(const ArcEnd&, const ArcEnd&) = default;
};

// Joins arcs that meet in bends.
class ArcJoiner {
 public:
  ArcJoiner(const ThinPoints& points, const Clusters& clusters, std::vector<Branch> arcs,
            StopPoll& poll)
      : clusters_(clusters),
        arcs_(std::move(arcs)),
        poll_(poll),
        joined_(arcs_.size()),
        ends_at_(clusters.size()),
        bend_paths_(points, clusters.inner_masks()) {
    for (size_t n = 0; n < arcs_.size(); ++n) {
      for (ArcSide side : {ArcSide::kSource, ArcSide::kTarget}) {
        const ClusterIndex c = ClusterAt({n, side});
        if (clusters_[c].IsBend()) ends_at_[c].push_back({n, side});
      }
    }
  }

  Branches Join() {
    Branches branches;
    for (size_t n = 0; n < arcs_.size() && !poll_.Stopped(); ++n) {
      for (ArcSide side : {ArcSide::kSource, ArcSide::kTarget}) {
        if (joined_[n] != 0 || clusters_[ClusterAt({n, side})].IsBend()) continue;
        branches.between.push_back(Follow({n, side}));
      }
    }
    for (size_t n = 0; n < arcs_.size() && !poll_.Stopped(); ++n) {
      if (joined_[n] == 0) branches.closed.push_back(Follow({n, ArcSide::kSource}).points);
    }
    return branches;
  }

 private:
  ClusterIndex ClusterAt(ArcEnd end) const {
    return end.side == ArcSide::kSource ? arcs_[end.arc].source : arcs_[end.arc].target;
  }
  static ArcEnd FarEnd(ArcEnd end) {
    return {end.arc, end.side == ArcSide::kSource ? ArcSide::kTarget : ArcSide::kSource};
  }

  // From one end of an arc through all bends to a cluster that is none, or around a closed curve.
  Branch Follow(ArcEnd start) {
    Branch branch{ClusterAt(start), ClusterAt(FarEnd(start)), TakeArc(start)};
    for (ArcEnd far = FarEnd(start); clusters_[branch.target].IsBend();) {
      const std::vector<ArcEnd>& ends = ends_at_[branch.target];
      const ArcEnd next = ends[0] == far ? ends[1] : ends[0];
      const bool closes = joined_[next.arc] != 0;
      const PointPath arc = closes ? PointPath{branch.points.front()} : TakeArc(next);
      AppendBend(branch.points, arc.front());
      branch.points.insert(branch.points.end(), arc.begin() + 1, arc.end());
      if (closes) break;
      far = FarEnd(next);
      branch.target = ClusterAt(far);
    }
    return branch;
  }

  // The arc's points, starting at the given end.
  PointPath TakeArc(ArcEnd start) {
    joined_[start.arc] = 1;
    PointPath points = std::move(arcs_[start.arc].points);
    if (start.side == ArcSide::kTarget) std::ranges::reverse(points);
    return points;
  }

  // Goes on from the last point, which lies in a bend, to the bend's point `exit`.
  void AppendBend(PointPath& points, PointIndex exit) {
    bend_paths_.GrowFrom(points.back(), poll_);
    if (poll_.Stopped()) return;
    const PointPath inside = bend_paths_.PathTo(exit);
    points.insert(points.end(), inside.begin() + 1, inside.end());
  }

  const Clusters& clusters_;
  std::vector<Branch> arcs_;
  StopPoll& poll_;
  std::vector<uint8_t> joined_;
  std::vector<std::vector<ArcEnd>> ends_at_;  // by cluster, of bends only
  SpanningTrees bend_paths_;
};

}  // namespace

Branches FollowBranches(const ThinPoints& points, const Clusters& clusters, StopPoll& poll) {
  ArcWalk walk(points, clusters, poll);
  std::vector<Branch> arcs = walk.ArcsBetweenClusters();
  std::vector<PointPath> curves = walk.ClosedCurves();
  if (poll.Stopped()) return {};
  Branches branches = ArcJoiner(points, clusters, std::move(arcs), poll).Join();
  std::ranges::move(curves, std::back_inserter(branches.closed));
  return branches;
}

}  // namespace bccskel
