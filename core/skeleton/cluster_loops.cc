// Does: thins the cluster to a kernel without simple points, end points included, so that loops run
//       along its middle and all else is gone; then takes a shortest-path tree of the kernel and
//       closes it with edges outside the tree.
// Why it is right: contracting the tree leaves one loop per edge outside it, and each triangle says
//       that the sum of its (at most three) such edges is no loop. Over the integers modulo 2 these
//       relations are solved one by one for their longest edge; what is left free is a basis, and a
//       shortest one of its kind. Parts of space have no torsion, so modulo 2 loses nothing.
#include "core/skeleton/cluster_loops.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <map>
#include <queue>
#include <utility>

#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

// A sum of chords modulo 2: their numbers, increasing.
using ChordSum = std::vector<uint32_t>;

ChordSum Plus(const ChordSum& a, const ChordSum& b) {
  ChordSum sum;
  std::ranges::set_symmetric_difference(a, b, std::back_inserter(sum));
  return sum;
}

// Relations between chords, each solved for its last one.
class ChordRelations {
 public:
  void Add(ChordSum relation) {
    while (!relation.empty()) {
      const auto known = solved_.find(relation.back());
      if (known == solved_.end()) {
        solved_.emplace(relation.back(), relation);
        return;
      }
      relation = Plus(relation, known->second);
    }
  }
  bool IsFree(uint32_t chord) const { return !solved_.contains(chord); }

 private:
  std::map<uint32_t, ChordSum> solved_;
};

// Chords by their ends, smaller point first.
using ChordNumbers = std::map<std::pair<PointIndex, PointIndex>, uint32_t>;

// The chords among the sides of a triangle. Needs: corners increasing.
ChordSum SidesOf(const std::array<PointIndex, 3>& corners, const ChordNumbers& numbers) {
  ChordSum sides;
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
    const auto side =
        numbers.find({corners[static_cast<size_t>(a)], corners[static_cast<size_t>(b)]});
    if (side != numbers.end()) sides.push_back(side->second);
  }
  std::ranges::sort(sides);
  return sides;
}

}  // namespace

ClusterLoopFinder::ClusterLoopFinder(const ThinPoints& points, const Clusters& clusters,
                                     StopPoll& poll)
    : points_(points),
      poll_(poll),
      masks_(clusters.inner_masks().begin(), clusters.inner_masks().end()),
      trees_(points, masks_) {}

ClusterLoops ClusterLoopFinder::Find(const Cluster& cluster) {
  const std::vector<PointIndex> kernel = ThinToKernel(cluster);
  ClusterLoops loops;
  loops.at = points_.DeepestOf(kernel);
  trees_.GrowFrom(loops.at, poll_);
  const std::vector<Chord> chords = FindChords(kernel);
  if (poll_.StoppedNow()) return loops;
  const std::vector<uint8_t> is_free = FindFreeChords(kernel, chords);
  for (size_t n = 0; n < chords.size(); ++n) {
    if (is_free[n] != 0) loops.chords.push_back(chords[n]);
  }
  return loops;
}

// Removes simple points, shallow ones first. A set with loops never shrinks to one point, so points
// without neighbors in the set are those that are gone.
std::vector<PointIndex> ClusterLoopFinder::ThinToKernel(const Cluster& cluster) {
  using Turn = std::pair<float, PointIndex>;  // radius, then lattice order
  std::priority_queue<Turn, std::vector<Turn>, std::greater<>> turns;
  for (PointIndex p : cluster.points) turns.emplace(points_[p].radius, p);
  while (!turns.empty() && !poll_.Stopped()) {
    const PointIndex p = turns.top().second;
    turns.pop();
    const NeighborMask mask = masks_[p];
    if (!IsSimple(mask)) continue;
    TakeOut(p, points_, masks_);
    ForEachDirection(mask, [&](Direction d) {
      const PointIndex q = points_.Neighbor(p, d);
      turns.emplace(points_[q].radius, q);
    });
  }
  std::vector<PointIndex> kernel;
  std::ranges::copy_if(cluster.points, std::back_inserter(kernel),
                       [&](PointIndex p) { return masks_[p] != 0; });
  return kernel;
}

std::vector<Chord> ClusterLoopFinder::FindChords(std::span<const PointIndex> kernel) const {
  std::vector<Chord> chords;
  for (PointIndex a : kernel) {
    ForEachDirection(masks_[a], [&](Direction d) {
      const PointIndex b = points_.Neighbor(a, d);
      if (b < a || trees_.Parent(a) == b || trees_.Parent(b) == a) return;
      chords.push_back({trees_.Depth(a) + trees_.Depth(b) + 1, a, b});
    });
  }
  std::ranges::sort(chords);
  return chords;
}

// One flag for each chord.
std::vector<uint8_t> ClusterLoopFinder::FindFreeChords(std::span<const PointIndex> kernel,
                                                       std::span<const Chord> chords) {
  ChordNumbers numbers;
  for (const Chord& chord : chords) {
    numbers.emplace(std::pair{chord.a, chord.b}, static_cast<uint32_t>(numbers.size()));
  }
  ChordRelations relations;
  for (PointIndex a : kernel) {
    if (poll_.Stopped()) break;
    ForEachDirection(masks_[a], [&](Direction d) {
      const PointIndex b = points_.Neighbor(a, d);
      const unsigned shared = masks_[a] & NeighborsAmongN14(d);
      ForEachDirection(static_cast<NeighborMask>(shared), [&](Direction e) {
        const PointIndex c = points_.Neighbor(a, e);
        if (a < b && b < c) relations.Add(SidesOf({a, b, c}, numbers));
      });
    });
  }
  std::vector<uint8_t> is_free(chords.size());
  for (uint32_t n = 0; n < chords.size(); ++n) is_free[n] = relations.IsFree(n) ? 1 : 0;
  return is_free;
}

PointPath ClusterLoopFinder::CloseLoop(const Chord& chord) const {
  PointPath path = trees_.PathTo(chord.a);
  const PointPath back = trees_.PathTo(chord.b);
  path.insert(path.end(), back.rbegin(), back.rend());
  return path;
}

}  // namespace bccskel
