#include "core/distance/chamfer_distance.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <limits>

#include "core/distance/chamfer_rows.h"
#include "core/exec/status_macros.h"

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

template <typename T>
class DistanceScan {
 public:
  DistanceScan(const Volume& object, ChamferWeights weights, T* values)
      : bricks_(object.brick_count()),
        view_{object.padded_bricks().data(), object.neighbors().data(), values, weights} {
    const std::span<const BrickKey> keys = object.keys();
    for (BrickIndex n = 0; n < keys.size(); ++n) {
      const BrickCoordinates brick = keys[n].coordinates();
      if (n == 0 || brick.bz != keys[n - 1].coordinates().bz) slabs_.push_back({n, n, {}});
      slabs_.back().last = n + 1;
      slabs_.back().bricks[static_cast<size_t>(brick.sublattice)].push_back(n);
    }
  }

  absl::Status Run(const exec::Context& context) {
    const int workers = context.WorkersFor(bricks_);
    exec::Barrier barrier(workers);
    std::atomic<bool> stopped = false;
    context.Run([&](int worker) {
      if (worker >= workers) return;
      const exec::Share mine = exec::ShareOf(slabs_.size(), worker, workers);
      for (size_t s = mine.begin; s < mine.end && !context.ShouldStop(); ++s) {
        SweepWithinLayers(view_, slabs_[s].first, slabs_[s].last);
      }
      barrier.Wait();
      const Team team = {worker, workers, barrier, stopped, context};
      for (size_t s = 0; s < slabs_.size(); ++s) {
        if (!Raise(slabs_[s], team)) return;
      }
      for (size_t s = slabs_.size(); s-- > 0;) {
        if (!Lower(slabs_[s], team)) return;
      }
    });
    return context.StopStatus();
  }

 private:
  // The bricks of one bz.
  struct Slab {
    BrickIndex first = 0;
    BrickIndex last = 0;
    std::array<std::vector<BrickIndex>, 2> bricks;  // by sublattice
  };

  struct Team {
    int worker;
    int workers;
    exec::Barrier& barrier;
    std::atomic<bool>& stopped;
    const exec::Context& context;

    // All workers leave together, or the ones left would wait for the others for ever.
    bool GoesOn() const {
      if (worker == 0 && context.ShouldStop()) stopped.store(true, std::memory_order_relaxed);
      barrier.Wait();
      return !stopped.load(std::memory_order_relaxed);
    }
  };

  bool Raise(const Slab& slab, const Team& team) const {
    for (int k = 0; k < kBrickZ; ++k) {
      Join(slab, Sublattice::kEven, k, ScanDirection::kUpward, team);
      Join(slab, Sublattice::kOdd, k, ScanDirection::kUpward, team);
    }
    return team.GoesOn();
  }

  bool Lower(const Slab& slab, const Team& team) const {
    for (int k = kBrickZ - 1; k >= 0; --k) {
      Join(slab, Sublattice::kOdd, k, ScanDirection::kDownward, team);
      Join(slab, Sublattice::kEven, k, ScanDirection::kDownward, team);
    }
    return team.GoesOn();
  }

  // Layers follow each other, so the workers meet after each.
  void Join(const Slab& slab, Sublattice sublattice, int k, ScanDirection direction,
            const Team& team) const {
    const std::span<const BrickIndex> bricks = slab.bricks[static_cast<size_t>(sublattice)];
    const exec::Share share = exec::ShareOf(bricks.size(), team.worker, team.workers);
    JoinLayers(view_, sublattice, bricks.subspan(share.begin, share.end - share.begin), k,
               direction);
    team.barrier.Wait();
  }

  const size_t bricks_;
  const DistanceView<T> view_;
  std::vector<Slab> slabs_;
};

template <typename T>
absl::StatusOr<ChamferField> Compute(const Volume& object, ChamferWeights weights,
                                     const exec::Context& context) {
  exec::UninitializedVector<T> values((object.brick_count() + 1) * kBrickPoints);
  std::fill(values.end() - kBrickPoints, values.end(), T{0});  // the padding brick
  BCCSKEL_RETURN_IF_ERROR(DistanceScan<T>(object, weights, values.data()).Run(context));
  const T largest = LargestOf(std::span<const T>(values));
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
