#include "core/distance/chamfer_scan.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>
#include <utility>

#include "core/distance/chamfer_rows.h"
#include "core/distance/chamfer_section.h"
#include "core/exec/meeting_team.h"
#include "core/exec/status_macros.h"

// Does:  chamfer distance to the background for every point of the stored bricks.
// Paper: section 4, local distances sqrt(3) between D8 and 2 between D6 neighbors; for unequal
//        spacings the lengths of these steps in the world.
// Why it is right: nothing blocks a shortest path, so its steps may be taken in any order: first
//   the steps within a layer of constant z (D6 along x and y), then those that raise z, then those
//   that lower it. All points of a shortest path to the nearest background point are object points,
//   so bricks that are not stored count as background and are not needed otherwise. In a window,
//   steps that all go up at first may lead outside, so steps up and down are paired: pairs are
//   taken within layers, and the rest goes only up or only down.
// Cost:  one pass within layers, one up, one down; each reads and writes 2 bytes per point.

namespace bccskel {
namespace {

std::vector<BrickSlab> SlabsOf(const Volume& object) {
  std::vector<BrickSlab> slabs;
  const std::span<const BrickKey> keys = object.keys();
  for (BrickIndex n = 0; n < keys.size(); ++n) {
    const BrickCoordinates brick = keys[n].coordinates();
    const BrickCoordinates before =
        n == 0 ? BrickCoordinates{-1, -1, -1} : keys[n - 1].coordinates();
    if (brick.bz != before.bz) slabs.push_back({n, n, {}, {}});
    if (brick.bz != before.bz || brick.by != before.by) slabs.back().lines.push_back(n);
    slabs.back().last = n + 1;
    slabs.back().bricks[static_cast<size_t>(brick.sublattice)].push_back(n);
  }
  return slabs;
}

// Both scans over a section.
template <typename T>
class SectionScan {
 public:
  // Called on each worker with its share of a slab whose distances are final.
  using OnFinal = std::function<void(BrickIndex first, BrickIndex last)>;

  SectionScan(ChamferSection<T>& section, const ChamferWeights& weights, const RunTables* runs,
              const exec::Context& context)
      : slabs_(section.slabs()), view_(section.View(weights, runs)), context_(context) {}

  void Rise() const {
    const int sweepers = context_.WorkersFor(brick_count(), kSweepWork);
    const bool alone = sweepers == 1;
    if (!alone) SweepTogether(sweepers);
    exec::MeetingTeam team(LayerWorkers(), context_);
    team.Run([&](int worker) {
      for (const BrickSlab& slab : slabs_) {
        // The slab is then still in the cache for the upward scan.
        if (alone) Sweep(slab);
        Raise(slab, worker, team);
        if (!team.GoOn(worker)) return;
      }
    });
  }

  void Fall(const OnFinal& on_final) const {
    exec::MeetingTeam team(LayerWorkers(), context_);
    team.Run([&](int worker) {
      for (size_t s = slabs_.size(); s-- > 0;) {
        const BrickSlab& slab = slabs_[s];
        Lower(slab, worker, team);
        const exec::Share share = team.ShareOf(slab.size(), worker);
        on_final(slab.first + static_cast<BrickIndex>(share.begin),
                 slab.first + static_cast<BrickIndex>(share.end));
        if (!team.GoOn(worker)) return;
      }
    });
  }

 private:
  // Work per brick, for Context::WorkersFor(): workers that sweep take whole slabs; others meet
  // after each layer of a slab, where they have nearly the same to do.
  static constexpr size_t kSweepWork = 8, kLayerWork = 8;

  size_t brick_count() const {
    size_t bricks = 0;
    for (const BrickSlab& slab : slabs_) bricks += slab.size();
    return bricks;
  }
  int LayerWorkers() const {
    if (slabs_.empty()) return 1;
    return context_.MeetingWorkersFor(brick_count() / slabs_.size(), kLayerWork);
  }

  void SweepTogether(int workers) const {
    (void)context_.ForEach(workers, slabs_.size(), 1,
                           [&](int) { return [&](size_t n) { Sweep(slabs_[n]); }; });
  }

  void Sweep(const BrickSlab& slab) const {
    SweepWithinLayers(view_, slab.first, slab.last);
    if (view_.unknown.has_value()) SpreadInPairs(view_, slab);
  }

  void Raise(const BrickSlab& slab, int worker, exec::MeetingTeam& team) const {
    for (int k = 0; k < kBrickZ; ++k) {
      Join(slab, Sublattice::kEven, k, ScanDirection::kUpward, worker, team);
      Join(slab, Sublattice::kOdd, k, ScanDirection::kUpward, worker, team);
    }
  }

  void Lower(const BrickSlab& slab, int worker, exec::MeetingTeam& team) const {
    for (int k = kBrickZ - 1; k >= 0; --k) {
      Join(slab, Sublattice::kOdd, k, ScanDirection::kDownward, worker, team);
      Join(slab, Sublattice::kEven, k, ScanDirection::kDownward, worker, team);
    }
  }

  // Layers depend on each other, so the workers meet after each.
  void Join(const BrickSlab& slab, Sublattice sublattice, int k, ScanDirection direction,
            int worker, exec::MeetingTeam& team) const {
    const std::span<const BrickIndex> bricks = slab.bricks[static_cast<size_t>(sublattice)];
    const exec::Share share = team.ShareOf(bricks.size(), worker);
    JoinLayers(view_, sublattice, bricks.subspan(share.begin, share.end - share.begin), k,
               direction);
    team.Meet(worker);
  }

  const std::span<const BrickSlab> slabs_;
  const DistanceView<T> view_;
  const exec::Context& context_;
};

// Counts of every point of the stored bricks and of the padding brick.
template <typename T>
absl::StatusOr<exec::UninitializedVector<T>> Scan(const Volume& object,
                                                  const ChamferWeights& weights,
                                                  const RunTables* runs,
                                                  const exec::Context& context) {
  const std::vector<BrickSlab> slabs = SlabsOf(object);
  ChamferSection<T> section(object, slabs);
  const SectionScan<T> scan(section, weights, runs, context);
  scan.Rise();
  scan.Fall([](BrickIndex, BrickIndex) {});
  BCCSKEL_RETURN_IF_ERROR(context.StopStatus());
  return std::move(section).TakeValues();
}

// Points of a section where an object has several; more if less would not save memory. A slab with
// more points is still one section.
constexpr size_t kSectionPoints = size_t{1} << 22;

// The data that a holder passes to the next: distances and the layer of bricks to which they
// belong.
template <typename T>
LayerRelay::Bytes PackLayer(int32_t bz, const exec::UninitializedVector<T>& layer) {
  LayerRelay::Bytes bytes(sizeof(bz) + layer.size() * sizeof(T));
  std::memcpy(bytes.data(), &bz, sizeof(bz));
  std::memcpy(bytes.data() + sizeof(bz), layer.data(), layer.size() * sizeof(T));
  return bytes;
}

// Empty if the distances belong to another layer: then none is next to the section.
template <typename T>
exec::UninitializedVector<T> UnpackLayer(const LayerRelay::Bytes& bytes, int32_t wanted) {
  int32_t bz = -1;
  if (bytes.size() < sizeof(bz)) return {};
  std::memcpy(&bz, bytes.data(), sizeof(bz));
  if (bz != wanted) return {};
  exec::UninitializedVector<T> layer((bytes.size() - sizeof(bz)) / sizeof(T));
  std::memcpy(layer.data(), bytes.data() + sizeof(bz), layer.size() * sizeof(T));
  return layer;
}

// For an object that one holder has as a whole.
class NoRelay : public LayerRelay {
 public:
  Bytes TakeFromBelow() override { return {}; }
  void GiveAbove(const Bytes&) override {}
  Bytes TakeFromAbove() override { return {}; }
  void GiveBelow(const Bytes&) override {}
  uint32_t Largest(uint32_t own) override { return own; }
};

// Scans a holder's layers section by section: first all upward, keeping the top layer of each, then
// all downward, where each but the last is scanned upward once more.
template <typename T>
class Stream {
 public:
  Stream(const Volume& object, const HeldLayers& held, const ChamferWeights& weights,
         const RunTables* runs, const exec::Context& context, size_t at_once)
      : object_(object),
        weights_(weights),
        runs_(runs),
        context_(context),
        slabs_(SlabsOf(object)) {
    size_t first = 0, last = slabs_.size(), held_points = 0;
    while (first < last && LayerOf(first) < held.first) ++first;
    while (last > first && LayerOf(last - 1) >= held.end) --last;
    for (size_t s = first; s < last; ++s) held_points += slabs_[s].size() * kBrickPoints;
    const size_t most = held_points <= at_once ? at_once
                                               : std::max(std::min(at_once, kSectionPoints),
                                                          LeastMemory(held_points, last - first));
    size_t points = 0;
    for (size_t s = first; s < last; ++s) {
      if (points == 0 || points + slabs_[s].size() * kBrickPoints > most) {
        starts_.push_back(s);
        points = 0;
      }
      points += slabs_[s].size() * kBrickPoints;
    }
    starts_.push_back(last);
  }

  // Returns the largest distance of all holders, or a number of `limit` or more if the type was too
  // small. A holder that has to stop still gives and takes layers, since others would wait for it.
  uint32_t Run(uint32_t limit, DistanceSink& sink, LayerRelay& relay) {
    if (sections() == 0) {
      relay.GiveAbove(relay.TakeFromBelow());
      relay.GiveBelow(relay.TakeFromAbove());
      return relay.Largest(0);
    }
    const size_t first = starts_.front(), last = starts_.back() - 1;
    below_ = UnpackLayer<T>(relay.TakeFromBelow(), first > 0 ? LayerOf(first - 1) : -2);
    for (size_t n = 0; n + 1 < sections() && !context_.ShouldStop(); ++n) {
      tops_.push_back(Risen(n).TopLayer());
    }
    if (context_.ShouldStop()) return PassVoid(relay);
    highest_.emplace(Risen(sections() - 1));
    relay.GiveAbove(PackLayer(LayerOf(last), highest_->TopLayer()));
    above_ =
        UnpackLayer<T>(relay.TakeFromAbove(), last + 1 < slabs_.size() ? LayerOf(last + 1) : -2);
    std::atomic<uint32_t> largest = 0;
    for (size_t n = sections(); n-- > 0 && largest < limit && !context_.ShouldStop();) {
      Finish(n, sink, largest);
    }
    relay.GiveBelow(PackLayer(LayerOf(first), above_));
    return relay.Largest(largest);
  }

 private:
  using Layer = typename ChamferSection<T>::Layer;

  // The section size that minimizes the memory of a section and the top layers of the others: k of
  // s slabs take k slabs and s / k / kBrickZ.
  static size_t LeastMemory(size_t points, size_t slabs) {
    const double sections = std::sqrt(static_cast<double>(kBrickZ) * static_cast<double>(slabs));
    return static_cast<size_t>(static_cast<double>(points) / sections);
  }

  size_t sections() const { return starts_.size() - 1; }
  int32_t LayerOf(size_t slab) const { return object_.keys()[slabs_[slab].first].coordinates().bz; }

  static uint32_t PassVoid(LayerRelay& relay) {
    relay.GiveAbove({});
    relay.TakeFromAbove();
    relay.GiveBelow({});
    return relay.Largest(0);
  }

  ChamferSection<T> Risen(size_t n) const {
    ChamferSection<T> section(object_, slabs_, starts_[n], starts_[n + 1]);
    section.SetLayerBelow(n > 0 ? tops_[n - 1] : below_);
    SectionScan<T>(section, weights_, runs_, context_).Rise();
    return section;
  }

  void Finish(size_t n, DistanceSink& sink, std::atomic<uint32_t>& largest) {
    ChamferSection<T> section = highest_.has_value() ? *std::move(highest_) : Risen(n);
    highest_.reset();
    section.SetLayerAbove(above_);
    const auto take = [&](BrickIndex first, BrickIndex last) {
      uint32_t most = 0;
      for (BrickIndex brick = first; brick < last; ++brick) {
        most = std::max(most, sink.Take(section.start() + brick, section.Of(brick)));
      }
      uint32_t before = largest.load();
      while (before < most && !largest.compare_exchange_weak(before, most)) {
      }
    };
    SectionScan<T>(section, weights_, runs_, context_).Fall(take);
    above_ = section.BottomLayer();
  }

  const Volume& object_;
  const ChamferWeights weights_;
  const RunTables* const runs_;
  const exec::Context& context_;
  const std::vector<BrickSlab> slabs_;
  std::vector<size_t> starts_;                // of the sections, with the end as the last entry
  Layer below_;                               // below the first section
  std::vector<Layer> tops_;                   // of the sections, after the upward scan
  Layer above_;                               // above the section that is finished next
  std::optional<ChamferSection<T>> highest_;  // after the upward scan
};

// Cached for equal spacing: small objects would spend more time on the tables than on their points.
RunTables RunTablesOf(const ChamferWeights& weights) {
  static const RunTables equal_spacing = RunTablesFor(kShortChamfer);
  return weights == kShortChamfer ? equal_spacing : RunTablesFor(weights);
}

ChamferWeights InUnitOf(DistanceKind kind, const ChamferWeights& weights, const AxisScale& scale) {
  return kind == DistanceKind::kChamferOptimal ? WithOptimalUnit(weights, scale) : weights;
}

}  // namespace

// Tries 16 bits first: hardly any object is too thick for them, and a bound from the box would send
// thin trees in large boxes the slow way.
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

absl::Status StreamChamfer(const Volume& object, DistanceKind kind, const exec::Context& context,
                           DistanceSink& sink, size_t at_once) {
  NoRelay alone;
  return StreamChamferOfLayers(object, {}, kind, context, sink, alone, at_once);
}

absl::Status StreamChamferOfLayers(const Volume& object, const HeldLayers& held, DistanceKind kind,
                                   const exec::Context& context, DistanceSink& sink,
                                   LayerRelay& relay, size_t at_once) {
  const AxisScale scale = AxisScaleOf(object.placement());
  const ChamferWeights weights = ShortWeights(scale);
  if (FitShortRows(weights)) {
    const RunTables runs = RunTablesOf(weights);
    sink.Begin(InUnitOf(kind, weights, scale), runs.limit());
    Stream<uint16_t> stream(object, held, weights, &runs, context, at_once);
    if (stream.Run(runs.limit(), sink, relay) < runs.limit()) return context.StopStatus();
  }
  const ChamferWeights wide = LongWeights(scale);
  sink.Begin(InUnitOf(kind, wide, scale), UINT32_MAX);
  Stream<uint32_t> stream(object, held, wide, nullptr, context, at_once);
  stream.Run(UINT32_MAX, sink, relay);
  return context.StopStatus();
}

}  // namespace bccskel
