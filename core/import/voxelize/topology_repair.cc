#include "core/import/voxelize/topology_repair.h"

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/exec/status_macros.h"
#include "core/lattice/directions.h"
#include "core/lattice/lattice_point_hash.h"
#include "core/prepare/denoise.h"
#include "core/prepare/keep_components.h"
#include "core/topology/simple_point_table.h"

namespace bccskel {
namespace {

using PointSet = std::unordered_set<LatticePoint, LatticePointHash>;

// Points of `a` that are not in `b`, in the order of a volume's bricks.
std::vector<LatticePoint> PointsOnlyIn(const Volume& a, const Volume& b) {
  std::vector<LatticePoint> points;
  for (size_t n = 0; n < a.brick_count(); ++n) {
    BrickBits bits = a.bricks()[n];
    if (const auto other = b.Find(a.keys()[n])) {
      for (size_t word = 0; word < bits.words.size(); ++word) {
        bits.words[word] &= ~b.bricks()[*other].words[word];
      }
    }
    const BrickCoordinates brick = a.keys()[n].coordinates();
    bits.ForEachSetBit([&](int bit) { points.push_back(PointOf(brick, bit)); });
  }
  return points;
}

// A volume in which simple points are exchanged for background and back.
class SimpleFlips {
 public:
  explicit SimpleFlips(const Volume& volume) : volume_(volume) {}

  // Flips points as long as one of them is simple: first in their order, later as neighbors of
  // those flipped.
  void Flip(const std::vector<LatticePoint>& points) {
    PointSet waiting(points.begin(), points.end());
    std::deque<LatticePoint> queue(points.begin(), points.end());
    for (; !queue.empty(); queue.pop_front()) {
      const LatticePoint p = queue.front();
      if (!waiting.contains(p) || !IsSimple(NeighborsOf(p))) continue;
      waiting.erase(p);
      flipped_.insert(p);
      for (int bit = 0; bit < kNeighborCount; ++bit) {
        const LatticePoint neighbor = p + Direction(bit).offset();
        if (waiting.contains(neighbor)) queue.push_back(neighbor);
      }
    }
  }

  absl::StatusOr<Volume> Take() && {
    VolumeBuilder builder(volume_.extent(), volume_.placement());
    for (size_t n = 0; n < volume_.brick_count(); ++n) {
      builder.Brick(volume_.keys()[n]) = volume_.bricks()[n];
    }
    for (const LatticePoint p : flipped_) {
      if (volume_.Contains(p)) {
        builder.Remove(p);
      } else {
        builder.Add(p);
      }
    }
    return std::move(builder).Build();
  }

 private:
  bool Contains(LatticePoint p) const { return volume_.Contains(p) != flipped_.contains(p); }
  NeighborMask NeighborsOf(LatticePoint p) const {
    unsigned mask = 0;
    for (int bit = 0; bit < kNeighborCount; ++bit) {
      mask |= static_cast<unsigned>(Contains(p + Direction(bit).offset())) << bit;
    }
    return static_cast<NeighborMask>(mask);
  }

  const Volume& volume_;
  PointSet flipped_;
};

// The majority, once or twice, that is nearest to the wanted topology; nothing if none is nearer
// than the sampling, or lacks a loop.
absl::StatusOr<std::optional<Volume>> BestMajority(const Volume& sampling, int64_t most_loops,
                                                   const BettiNumbers& wanted,
                                                   const exec::Context& context) {
  constexpr int kMostPasses = 4;
  std::optional<Volume> best;
  Volume majority = sampling;
  for (int pass = 0; pass < kMostPasses && most_loops != wanted.loops; ++pass) {
    BCCSKEL_ASSIGN_OR_RETURN(ChangedVolume denoised, Denoise(majority, context));
    majority = std::move(denoised.object);
    if (wanted.components == 1) {  // denoising parts what hangs by few points
      BCCSKEL_ASSIGN_OR_RETURN(ChangedVolume largest, KeepLargestComponent(majority, context));
      majority = std::move(largest.object);
    }
    BCCSKEL_ASSIGN_OR_RETURN(const BettiNumbers found, CountBettiNumbers(majority, context));
    const bool nearer = found.components == wanted.components &&
                        found.cavities == wanted.cavities && found.loops >= wanted.loops &&
                        found.loops < most_loops;
    if (!nearer) continue;
    best = majority;
    most_loops = found.loops;
  }
  return best;
}

}  // namespace

absl::StatusOr<Volume> RepairTopology(Volume sampling, const BettiNumbers& found,
                                      const BettiNumbers& wanted, const exec::Context& context) {
  const bool lacks = found.components < wanted.components || found.loops < wanted.loops ||
                     found.cavities < wanted.cavities;
  if (lacks) return sampling;  // parts touch, or walls are thinner than a cell
  const bool only_loops =
      found.components == wanted.components && found.cavities == wanted.cavities;
  const int64_t most_loops = only_loops ? found.loops : std::numeric_limits<int64_t>::max();
  BCCSKEL_ASSIGN_OR_RETURN(const std::optional<Volume> majority,
                           BestMajority(sampling, most_loops, wanted, context));
  if (!majority.has_value()) return sampling;
  SimpleFlips flips(*majority);
  flips.Flip(PointsOnlyIn(sampling, *majority));
  flips.Flip(PointsOnlyIn(*majority, sampling));
  return std::move(flips).Take();
}

}  // namespace bccskel
