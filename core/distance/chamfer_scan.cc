#include "core/distance/chamfer_scan.h"

#include <algorithm>
#include <array>

#include "core/distance/chamfer_rows.h"
#include "core/exec/status_macros.h"

// Does:  chamfer distance to the background for every point of the stored bricks.
// Paper: section 4, local distances sqrt(3) between D8 and 2 between D6 neighbors; for unequal
//        spacings the lengths that these steps have in the world.
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
  DistanceScan(const Volume& object, const ChamferWeights& weights, const RunTables* runs,
               T* values)
      : bricks_(object.brick_count()),
        view_{object.padded_bricks().data(), object.neighbors().data(), values, weights, runs} {
    const std::span<const BrickKey> keys = object.keys();
    for (BrickIndex n = 0; n < keys.size(); ++n) {
      const BrickCoordinates brick = keys[n].coordinates();
      if (n == 0 || brick.bz != keys[n - 1].coordinates().bz) slabs_.push_back({n, n, {}});
      slabs_.back().last = n + 1;
      slabs_.back().bricks[static_cast<size_t>(brick.sublattice)].push_back(n);
    }
  }

  absl::Status Run(const exec::Context& context) {
    context.Run([&](int worker) {
      const exec::Share mine = exec::ShareOf(slabs_.size(), worker, context.threads());
      for (size_t s = mine.begin; s < mine.end && !context.ShouldStop(); ++s) {
        SweepWithinLayers(view_, slabs_[s].first, slabs_[s].last);
      }
    });
    Team team(WorkersFor(context), context);
    if (team.size() == 1) {
      JoinAll(0, team);
    } else {
      context.Run([&](int worker) {
        if (worker >= team.size()) return;
        team.Guard([&] { JoinAll(worker, team); });
      });
    }
    return context.StopStatus();
  }

 private:
  // The bricks of one bz.
  struct Slab {
    BrickIndex first = 0;
    BrickIndex last = 0;
    std::array<std::vector<BrickIndex>, 2> bricks;  // by sublattice
  };

  // Workers that go from layer to layer together.
  class Team {
   public:
    Team(int size, const exec::Context& context)
        : size_(size), context_(context), barrier_(size), patience_(context.patience) {}

    int size() const { return size_; }
    template <typename Part>
    void Guard(Part part) {
      barrier_.Guard(part);
    }
    // How many are still at it.
    int present() const { return alone_ ? 1 : size_; }

    void Meet(int worker) {
      if (present() == 1) return;
      const exec::Barrier::Duration blocked = barrier_.Wait();
      if (worker == 0) patience_.Blocked(blocked);
    }

    // Whether this worker goes on to the next slab. All decide the same, or some would wait for
    // others for ever.
    bool GoOn(int worker) {
      if (alone_) return !context_.ShouldStop();
      if (worker == 0) {
        stopped_ = context_.ShouldStop();
        leave_ = patience_.Lost();
      }
      Meet(worker);
      if (stopped_ || (leave_ && worker != 0)) return false;
      if (leave_) alone_ = true;
      return true;
    }

   private:
    const int size_;
    const exec::Context& context_;
    exec::Barrier barrier_;
    exec::Patience patience_;  // worker 0's
    // Written by worker 0 before a meeting that all others reach after they have read the last
    // value.
    bool stopped_ = false;
    bool leave_ = false;
    bool alone_ = false;  // read by worker 0 only once the others leave
  };

  // What counts is the work between two meetings: a layer of a slab, not all bricks. A layer of a
  // quarter of the bricks that a worker needs elsewhere is enough.
  int WorkersFor(const exec::Context& context) const {
    return slabs_.empty() ? 1 : context.WorkersFor(4 * bricks_ / slabs_.size());
  }

  void JoinAll(int worker, Team& team) const {
    for (const Slab& slab : slabs_) {
      Raise(slab, worker, team);
      if (!team.GoOn(worker)) return;
    }
    for (size_t s = slabs_.size(); s-- > 0;) {
      Lower(slabs_[s], worker, team);
      if (!team.GoOn(worker)) return;
    }
  }

  void Raise(const Slab& slab, int worker, Team& team) const {
    for (int k = 0; k < kBrickZ; ++k) {
      Join(slab, Sublattice::kEven, k, ScanDirection::kUpward, worker, team);
      Join(slab, Sublattice::kOdd, k, ScanDirection::kUpward, worker, team);
    }
  }

  void Lower(const Slab& slab, int worker, Team& team) const {
    for (int k = kBrickZ - 1; k >= 0; --k) {
      Join(slab, Sublattice::kOdd, k, ScanDirection::kDownward, worker, team);
      Join(slab, Sublattice::kEven, k, ScanDirection::kDownward, worker, team);
    }
  }

  // Layers follow each other, so the workers meet after each.
  void Join(const Slab& slab, Sublattice sublattice, int k, ScanDirection direction, int worker,
            Team& team) const {
    const std::span<const BrickIndex> bricks = slab.bricks[static_cast<size_t>(sublattice)];
    const exec::Share share = exec::ShareOf(bricks.size(), worker, team.present());
    JoinLayers(view_, sublattice, bricks.subspan(share.begin, share.end - share.begin), k,
               direction);
    team.Meet(worker);
  }

  const size_t bricks_;
  const DistanceView<T> view_;
  std::vector<Slab> slabs_;
};

// Counts of every point of the stored bricks and of the padding brick.
template <typename T>
absl::StatusOr<exec::UninitializedVector<T>> Scan(const Volume& object,
                                                  const ChamferWeights& weights,
                                                  const RunTables* runs,
                                                  const exec::Context& context) {
  exec::UninitializedVector<T> values((object.brick_count() + 1) * kBrickPoints);
  std::fill(values.end() - kBrickPoints, values.end(), T{0});  // the padding brick
  BCCSKEL_RETURN_IF_ERROR(DistanceScan<T>(object, weights, runs, values.data()).Run(context));
  return values;
}

// Made once for equal spacing: small objects would spend more time on them than on their points.
RunTables RunTablesOf(const ChamferWeights& weights) {
  static const RunTables equal_spacing = RunTablesFor(kShortChamfer);
  return weights == kShortChamfer ? equal_spacing : RunTablesFor(weights);
}

ChamferWeights InUnitOf(DistanceKind kind, const ChamferWeights& weights, const AxisScale& scale) {
  return kind == DistanceKind::kChamferOptimal ? WithOptimalUnit(weights, scale) : weights;
}

}  // namespace

// Hardly any object is too thick for 16 bits, and a bound from the box would send thin trees in
// large boxes the slow way.
absl::StatusOr<DistanceField> ComputeChamfer(const Volume& object, DistanceKind kind,
                                             const exec::Context& context) {
  const AxisScale scale = AxisScaleOf(object.placement());
  const ChamferWeights weights = ShortWeights(scale);
  if (FitShortRows(weights)) {
    const RunTables runs = RunTablesOf(weights);
    BCCSKEL_ASSIGN_OR_RETURN(auto values, Scan<uint16_t>(object, weights, &runs, context));
    const uint16_t largest = LargestOf(std::span<const uint16_t>(values));
    if (largest < runs.limit()) {
      return DistanceField(kind, InUnitOf(kind, weights, scale), std::move(values), largest);
    }
  }
  const ChamferWeights wide = LongWeights(scale);
  BCCSKEL_ASSIGN_OR_RETURN(auto values, Scan<uint32_t>(object, wide, nullptr, context));
  const uint32_t largest = LargestOf(std::span<const uint32_t>(values));
  return DistanceField(kind, InUnitOf(kind, wide, scale), std::move(values), largest);
}

}  // namespace bccskel
