// Loops and cavities of a cluster from its points' neighborhoods alone.
//
// Euler characteristic: put the points in by increasing x + y + z. A point adds 1 - chi(L), L being
// its neighbors that are in already. The seven neighbors below a point form a hexagon around the
// hub (-1,-1,-1) (see core/certificate/euler_characteristic.cc): chi(L) is 1 with the hub, else the
// number of arcs, else, for the whole hexagon, 0.
//
// Cavities: a point of the bcc grid stands for its Voronoi cell, and at most four cells meet, so
// the border of a set of cells is made of closed surfaces without branching. A connected set has
// one outer surface and one for each cavity. A patch of surface is a point with one component of
// its background neighbors; patches of neighboring points p and r belong together when both see the
// same background point q:
//
//        q           faces (p,q) and (r,q) share an edge of the surface
//       / \          faces (p,q) and (p,s) share one when q and s are adjacent: q and s are in one
//      p---r         component of the background neighbors of p
//
// Loops then follow from 1 - loops + cavities = chi.
#include "core/skeleton/clusters.h"

#include <algorithm>
#include <array>

#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

bool HasPlainCurveMask(NeighborMask mask) { return IsCurvePoint(mask) && ComponentsIn(mask) == 2; }

constexpr NeighborMask kHub = FindDirection({-1, -1, -1})->mask();

constexpr NeighborMask ComputeRim() {
  unsigned rim = 0;
  for (int d = 0; d < kNeighborCount; ++d) {
    const LatticePoint offset = Direction(d).offset();
    if (offset.x + offset.y + offset.z < 0) rim |= Direction(d).mask();
  }
  return static_cast<NeighborMask>(rim & ~unsigned{kHub});
}
constexpr NeighborMask kRim = ComputeRim();
static_assert(NeighborsIn(kRim) == 6 && ComponentsIn(kRim) == 1);
static_assert((NeighborsAmongN14(Direction(0)) & kRim) == kRim);

int EulerTerm(NeighborMask mask) {
  if ((mask & kHub) != 0 || (mask & kRim) == kRim) return (mask & kHub) != 0 ? 0 : 1;
  return 1 - ComponentsIn(mask & kRim);
}

// kSeenFrom[d][e]: the direction in which p's neighbor along d sees p's neighbor along e. Only read
// for adjacent neighbors.
constexpr auto kSeenFrom = [] {
  std::array<std::array<uint8_t, kNeighborCount>, kNeighborCount> table = {};
  for (int d = 0; d < kNeighborCount; ++d) {
    for (int e = 0; e < kNeighborCount; ++e) {
      const auto seen = FindDirection(Direction(e).offset() - Direction(d).offset());
      if (!seen) continue;
      table[static_cast<size_t>(d)][static_cast<size_t>(e)] = static_cast<uint8_t>(seen->bit());
    }
  }
  return table;
}();

NeighborMask BackgroundOf(NeighborMask mask) {
  return static_cast<NeighborMask>(~mask & kAllNeighbors);
}

struct Patch {
  PointIndex point;
  NeighborMask background;  // one component
};

class SurfaceWalk {
 public:
  SurfaceWalk(const ThinPoints& points, std::span<const NeighborMask> masks,
              std::span<NeighborMask> seen, StopPoll& poll)
      : points_(points), masks_(masks), seen_(seen), poll_(poll) {}

  // The number of surfaces that start at p and that no earlier call has walked over.
  uint32_t CountNewSurfaces(PointIndex p) {
    uint32_t surfaces = 0;
    const unsigned unseen = BackgroundOf(masks_[p]) & ~unsigned{seen_[p]};
    ForEachDirection(static_cast<NeighborMask>(unseen), [&](Direction q) {
      if (!Enter(p, q)) return;
      ++surfaces;
      while (!open_.empty() && !poll_.Stopped()) LeavePatch();
    });
    return surfaces;
  }

 private:
  // Opens the patch of p that sees its background neighbor along q, unless it was open before.
  bool Enter(PointIndex p, Direction q) {
    if ((seen_[p] & q.mask()) != 0) return false;
    const NeighborMask patch = ComponentAround(q.mask(), BackgroundOf(masks_[p]));
    seen_[p] = static_cast<NeighborMask>(seen_[p] | patch);
    open_.push_back({p, patch});
    return true;
  }

  void LeavePatch() {
    const Patch patch = open_.back();
    open_.pop_back();
    ForEachDirection(masks_[patch.point], [&](Direction d) {
      const unsigned shared = NeighborsAmongN14(d) & patch.background;
      if (shared == 0) return;
      const PointIndex r = points_.Neighbor(patch.point, d);
      if (seen_[r] == BackgroundOf(masks_[r])) return;
      ForEachDirection(static_cast<NeighborMask>(shared), [&](Direction q) {
        Enter(r, Direction(kSeenFrom[static_cast<size_t>(d.bit())][static_cast<size_t>(q.bit())]));
      });
    });
  }

  const ThinPoints& points_;
  const std::span<const NeighborMask> masks_;
  const std::span<NeighborMask> seen_;
  StopPoll& poll_;
  std::vector<Patch> open_;
};

// Counts the loops and cavities of a cluster in isolation.
// Shapes: masks[p] has the neighbors of each of its points that belong to the cluster; `seen` is
//         scratch memory of the same size, zero for unvisited points.
// Cost:   proportional to the number of points.
void MeasureTopology(const ThinPoints& points, std::span<const NeighborMask> masks,
                     std::span<NeighborMask> seen, StopPoll& poll, Cluster& cluster) {
  int64_t chi = 0;
  for (PointIndex p : cluster.points) chi += EulerTerm(masks[p]);
  // It takes a point's 14 neighbors to enclose it.
  uint32_t surfaces = cluster.points.size() < kNeighborCount ? 1 : 0;
  if (surfaces == 0) {
    SurfaceWalk walk(points, masks, seen, poll);
    for (PointIndex p : cluster.points) {
      if (poll.Stopped()) break;
      surfaces += walk.CountNewSurfaces(p);
    }
  }
  cluster.cavities = surfaces - 1;
  cluster.loops = static_cast<uint32_t>(1 + int64_t{cluster.cavities} - chi);
}

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
    MeasureTopology(points, inner_masks_, seen, poll, cluster);
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
