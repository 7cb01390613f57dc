#include "core/import/voxelize/topology_repair.h"

#include <algorithm>
#include <cstdint>
#include <deque>
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

// How many components, loops and cavities more than wanted.
int64_t Surplus(const BettiNumbers& found, const BettiNumbers& wanted) {
  return std::max<int64_t>(0, found.components - wanted.components) +
         std::max<int64_t>(0, found.loops - wanted.loops) +
         std::max<int64_t>(0, found.cavities - wanted.cavities);
}

// Whether `after` has less of something than both.
bool Lacks(const BettiNumbers& after, const BettiNumbers& before, const BettiNumbers& wanted) {
  return after.components < std::min(before.components, wanted.components) ||
         after.loops < std::min(before.loops, wanted.loops) ||
         after.cavities < std::min(before.cavities, wanted.cavities);
}

// What hangs by few points is dust after a majority.
absl::StatusOr<Volume> WithoutDust(const Volume& volume, const BettiNumbers& wanted,
                                   const exec::Context& context) {
  constexpr uint64_t kLeastPart = 64;  // points
  BCCSKEL_ASSIGN_OR_RETURN(ChangedVolume kept,
                           wanted.components == 1
                               ? KeepLargestComponent(volume, context)
                               : DropSmallComponents(volume, kLeastPart, context));
  return std::move(kept.object);
}

// See the header; nothing where none is better than the sampling.
absl::StatusOr<std::optional<Volume>> BestMajority(const Volume& sampling,
                                                   const BettiNumbers& before,
                                                   const BettiNumbers& wanted,
                                                   const exec::Context& context) {
  constexpr int kMostPasses = 4;
  std::optional<Volume> best;
  int64_t least = Surplus(before, wanted);
  // Where parts cross, dust of the sampling may hide that they are one component.
  BCCSKEL_ASSIGN_OR_RETURN(Volume majority, WithoutDust(sampling, wanted, context));
  BCCSKEL_ASSIGN_OR_RETURN(const BettiNumbers firm, CountBettiNumbers(majority, context));
  BettiNumbers after = firm;
  for (int pass = 0;; ++pass) {
    const int64_t surplus = Surplus(after, wanted);
    if (surplus < least && !Lacks(after, firm, wanted)) {
      best = majority;
      least = surplus;
    }
    if (pass == kMostPasses || least == 0) return best;
    BCCSKEL_ASSIGN_OR_RETURN(ChangedVolume denoised, Denoise(majority, context));
    BCCSKEL_ASSIGN_OR_RETURN(majority, WithoutDust(denoised.object, wanted, context));
    BCCSKEL_ASSIGN_OR_RETURN(after, CountBettiNumbers(majority, context));
  }
}

}  // namespace

absl::StatusOr<Volume> RepairTopology(Volume sampling, const BettiNumbers& found,
                                      const BettiNumbers& wanted, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::optional<Volume> majority,
                           BestMajority(sampling, found, wanted, context));
  if (!majority.has_value()) return sampling;
  SimpleFlips flips(*majority);
  flips.Flip(PointsOnlyIn(sampling, *majority));
  flips.Flip(PointsOnlyIn(*majority, sampling));
  BCCSKEL_ASSIGN_OR_RETURN(Volume repaired, std::move(flips).Take());
  const bool much_is_lost = repaired.PointCount() < sampling.PointCount() / 16 * 15;
  return much_is_lost ? std::move(sampling) : std::move(repaired);
}

}  // namespace bccskel
