#include "core/distance/chamfer_distance.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

#include "core/volume/brick_neighbors.h"

// Does:  chamfer distance to the background for every point of the stored bricks.
// Paper: section 4, local distances sqrt(3) between D8 and 2 between D6 neighbors.
// Why it is right: nothing blocks a shortest path, so its steps may be taken in any order: first
// the
//   steps within a layer of constant z (D6 along x and y), then those that raise z, then those that
//   lower it. All points of a shortest path to the nearest background point are object points, so
//   bricks that are not stored count as background and nothing else is ever needed of them.
// Cost:  one pass within layers, one up, one down; 2 bytes per point read and written in each.

namespace bccskel {
namespace {

constexpr int kLayerPoints = kBrickX * kBrickY;

// Within a wide flat layer the first pass can exceed the type; the far value then stands for "more
// than any final distance", which DistanceBound() keeps below it.
template <typename T>
T SaturatedSum(T a, T b) {
  const T sum = static_cast<T>(a + b);
  return sum < a ? std::numeric_limits<T>::max() : sum;
}

template <typename T>
class DistanceScan {
 public:
  DistanceScan(const Volume& object, ChamferWeights weights, std::vector<T>& values)
      : object_(object),
        diagonal_(static_cast<T>(weights.diagonal)),
        axial_(static_cast<T>(weights.axial)),
        values_(values.data()),
        neighbors_(FindBrickNeighbors(object.keys())) {
    const std::span<const BrickKey> keys = object.keys();
    for (size_t n = 0; n < keys.size(); ++n) {
      if (n == 0 || keys[n].coordinates().bz != keys[n - 1].coordinates().bz) slabs_.push_back(n);
    }
    slabs_.push_back(keys.size());
  }

  absl::Status Run(const exec::Context& context) {
    const int workers = context.threads();
    exec::Barrier barrier(workers);
    std::vector<std::atomic<bool>> stopped(slabs_.size() * 2);
    context.Run([&](int worker) {
      const exec::Share mine = exec::ShareOf(slabs_.size() - 1, worker, workers);
      for (size_t s = mine.begin; s < mine.end && !context.ShouldStop(); ++s) SweepLayersOfSlab(s);
      barrier.Wait();
      for (size_t s = 0; s + 1 < slabs_.size(); ++s) {
        if (Agree(context, worker, barrier, stopped[s])) return;
        for (int k = 0; k < kBrickZ; ++k) {
          RaiseLayer(Slice(s, worker, workers), Sublattice::kEven, k);
          barrier.Wait();
          RaiseLayer(Slice(s, worker, workers), Sublattice::kOdd, k);
          barrier.Wait();
        }
      }
      for (size_t s = slabs_.size() - 1; s-- > 0;) {
        if (Agree(context, worker, barrier, stopped[slabs_.size() + s])) return;
        for (int k = kBrickZ - 1; k >= 0; --k) {
          LowerLayer(Slice(s, worker, workers), Sublattice::kOdd, k);
          barrier.Wait();
          LowerLayer(Slice(s, worker, workers), Sublattice::kEven, k);
          barrier.Wait();
        }
      }
    });
    return context.StopStatus();
  }

 private:
  // All workers leave together, or a barrier would wait for the ones that left.
  static bool Agree(const exec::Context& context, int worker, exec::Barrier& barrier,
                    std::atomic<bool>& stopped) {
    if (worker == 0) stopped.store(context.ShouldStop(), std::memory_order_relaxed);
    barrier.Wait();
    return stopped.load(std::memory_order_relaxed);
  }

  exec::Share Slice(size_t slab, int worker, int workers) const {
    const exec::Share share = exec::ShareOf(slabs_[slab + 1] - slabs_[slab], worker, workers);
    return {slabs_[slab] + share.begin, slabs_[slab] + share.end};
  }

  T* Row(BrickIndex brick, int k, int j) const {
    return values_ + size_t{brick} * kBrickPoints +
           static_cast<size_t>(k * kLayerPoints + j * kBrickX);
  }

  Sublattice SublatticeOfBrick(size_t brick) const {
    return object_.keys()[brick].coordinates().sublattice;
  }

  // Steps within layers. Bricks of a slab are ordered by (y, x), so a forward walk meets the
  // neighbors at -x and -y first, a backward walk those at +x and +y.
  void SweepLayersOfSlab(size_t slab) {
    for (size_t n = slabs_[slab]; n < slabs_[slab + 1]; ++n) {
      const auto brick = static_cast<BrickIndex>(n);
      for (int k = 0; k < kBrickZ; ++k) {
        for (int j = 0; j < kBrickY; ++j) SweepRowForward(brick, k, j);
      }
    }
    for (size_t n = slabs_[slab + 1]; n-- > slabs_[slab];) {
      const auto brick = static_cast<BrickIndex>(n);
      for (int k = 0; k < kBrickZ; ++k) {
        for (int j = kBrickY - 1; j >= 0; --j) SweepRowBackward(brick, k, j);
      }
    }
  }

  void SweepRowForward(BrickIndex brick, int k, int j) {
    const uint64_t bits = object_.bricks()[brick].words[static_cast<size_t>(k)] >> (kBrickX * j);
    const T* left = Row(neighbors_[brick][9], k, j);
    const T* below = j > 0 ? Row(brick, k, j - 1) : Row(neighbors_[brick][11], k, kBrickY - 1);
    T* row = Row(brick, k, j);
    T previous = left[kBrickX - 1];
    for (int i = 0; i < kBrickX; ++i) {
      const T near = std::min(previous, below[i]);
      previous = (bits >> i & 1) != 0 ? SaturatedSum(near, axial_) : T{0};
      row[i] = previous;
    }
  }

  void SweepRowBackward(BrickIndex brick, int k, int j) {
    const T* right = Row(neighbors_[brick][8], k, j);
    const T* above = j + 1 < kBrickY ? Row(brick, k, j + 1) : Row(neighbors_[brick][10], k, 0);
    T* row = Row(brick, k, j);
    T previous = right[0];
    for (int i = kBrickX - 1; i >= 0; --i) {
      previous = std::min(row[i], SaturatedSum(std::min(previous, above[i]), axial_));
      row[i] = previous;
    }
  }

  void RaiseLayer(exec::Share bricks, Sublattice sublattice, int k) {
    for (size_t n = bricks.begin; n < bricks.end; ++n) {
      if (SublatticeOfBrick(n) != sublattice) continue;
      const auto brick = static_cast<BrickIndex>(n);
      const BrickNeighborhood& near = neighbors_[n];
      const BrickIndex below = k > 0 ? brick : near[13];
      // Below an even layer lies the odd layer of index k - 1, below an odd one the even one of k.
      if (sublattice == Sublattice::kOdd) {
        JoinLayers(brick, k, {near[0], near[1], near[2], near[3]}, k, below, (k + 7) & 7);
      } else if (k > 0) {
        JoinLayers(brick, k, {near[0], near[1], near[2], near[3]}, k - 1, below, k - 1);
      } else {
        JoinLayers(brick, k, {near[4], near[5], near[6], near[7]}, 7, below, 7);
      }
    }
  }

  void LowerLayer(exec::Share bricks, Sublattice sublattice, int k) {
    for (size_t n = bricks.begin; n < bricks.end; ++n) {
      if (SublatticeOfBrick(n) != sublattice) continue;
      const auto brick = static_cast<BrickIndex>(n);
      const BrickNeighborhood& near = neighbors_[n];
      const BrickIndex above = k < 7 ? brick : near[12];
      if (sublattice == Sublattice::kEven) {
        JoinLayers(brick, k, {near[0], near[1], near[2], near[3]}, k, above, (k + 1) & 7);
      } else if (k < 7) {
        JoinLayers(brick, k, {near[0], near[1], near[2], near[3]}, k + 1, above, k + 1);
      } else {
        JoinLayers(brick, k, {near[4], near[5], near[6], near[7]}, 0, above, 0);
      }
    }
  }

  // Takes the minimum over one adjacent layer of the other sublattice (four D8 steps) and the next
  // layer of the own one (a D6 step). `diagonal` are the bricks of the other sublattice at the same
  // place, beside it in x, in y, and in both.
  void JoinLayers(BrickIndex brick, int k, std::array<BrickIndex, 4> diagonal, int diagonal_k,
                  BrickIndex axial, int axial_k) {
    const bool even = SublatticeOfBrick(brick) == Sublattice::kEven;
    for (int j = 0; j < kBrickY; ++j) {
      // The other two rows of D8 neighbors: one row back for even points, one forth for odd ones.
      const int side = even ? j - 1 : j + 1;
      const bool outside = side < 0 || side == kBrickY;
      const int side_j = side & (kBrickY - 1);
      const T* own = Row(diagonal[0], diagonal_k, j);
      const T* own_x = Row(diagonal[1], diagonal_k, j);
      const T* next = Row(diagonal[outside ? 2 : 0], diagonal_k, side_j);
      const T* next_x = Row(diagonal[outside ? 3 : 1], diagonal_k, side_j);
      std::array<T, kBrickX + 1> nearest;  // of the two rows, with the column from the brick beside
      for (int i = 0; i < kBrickX; ++i) {
        nearest[static_cast<size_t>(even ? i + 1 : i)] = std::min(own[i], next[i]);
      }
      nearest[even ? 0 : kBrickX] =
          even ? std::min(own_x[kBrickX - 1], next_x[kBrickX - 1]) : std::min(own_x[0], next_x[0]);
      const T* straight = Row(axial, axial_k, j);
      T* row = Row(brick, k, j);
      for (size_t i = 0; i < kBrickX; ++i) {
        const T by_diagonal = SaturatedSum(std::min(nearest[i], nearest[i + 1]), diagonal_);
        const T by_axis = SaturatedSum(straight[i], axial_);
        row[i] = std::min(row[i], std::min(by_diagonal, by_axis));
      }
    }
  }

  const Volume& object_;
  const T diagonal_;
  const T axial_;
  T* const values_;  // one brick longer than the object: the padding brick is background
  const std::vector<BrickNeighborhood> neighbors_;
  std::vector<size_t> slabs_;  // first brick of each brick layer, and the end
};

template <typename T>
absl::StatusOr<ChamferField> Compute(const Volume& object, ChamferWeights weights,
                                     const exec::Context& context) {
  std::vector<T> values((object.brick_count() + 1) * kBrickPoints);
  absl::Status status = DistanceScan<T>(object, weights, values).Run(context);
  if (!status.ok()) return status;
  const T largest = values.empty() ? T{0} : *std::ranges::max_element(values);
  return ChamferField(weights, std::move(values), largest);
}

// An upper bound of any distance, in lattice units: no point is farther from the outside of the
// object's bounding box than half its smallest side.
int64_t DistanceBound(const Volume& object) {
  std::array<int64_t, 3> low, high;
  low.fill(std::numeric_limits<int64_t>::max());
  high.fill(std::numeric_limits<int64_t>::min());
  for (const BrickKey key : object.keys()) {
    const BrickCoordinates c = key.coordinates();
    const std::array<int64_t, 3> corner = {c.bx * int64_t{kBrickX}, c.by * int64_t{kBrickY},
                                           c.bz * int64_t{kBrickZ}};
    const std::array<int64_t, 3> size = {kBrickX, kBrickY, kBrickZ};
    for (size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], corner[a]);
      high[a] = std::max(high[a], corner[a] + size[a]);
    }
  }
  int64_t cells = std::numeric_limits<int64_t>::max();
  for (size_t a = 0; a < 3; ++a) cells = std::min(cells, high[a] - low[a]);
  return cells + 2;  // a cell is two lattice units, halved
}

}  // namespace

uint32_t ChamferBetween(LatticePoint a, LatticePoint b, const ChamferWeights& weights) {
  std::array<uint32_t, 3> steps = {static_cast<uint32_t>(std::abs(a.x - b.x)),
                                   static_cast<uint32_t>(std::abs(a.y - b.y)),
                                   static_cast<uint32_t>(std::abs(a.z - b.z))};
  std::ranges::sort(steps);
  return weights.diagonal * steps[1] + weights.axial * ((steps[2] - steps[1]) / 2);
}

absl::StatusOr<ChamferField> ComputeChamferDistance(const Volume& object,
                                                    const exec::Context& context) {
  constexpr int64_t kShortLimit = 620;  // 65535 counts are 627 units, less one step
  if (object.empty() || DistanceBound(object) <= kShortLimit) {
    return Compute<uint16_t>(object, kShortChamfer, context);
  }
  return Compute<uint32_t>(object, kLongChamfer, context);
}

}  // namespace bccskel
