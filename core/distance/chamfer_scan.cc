#include "core/distance/chamfer_scan.h"

#include <algorithm>
#include <array>
#include <atomic>
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
//        spacings the lengths that these steps have in the world.
// Why it is right: nothing blocks a shortest path, so its steps may be taken in any order:
//   first the steps within a layer of constant z (D6 along x and y), then those that raise z, then
//   those that lower it. All points of a shortest path to the nearest background point are object
//   points, so bricks that are not stored count as background and nothing else is ever needed of
//   them.
// Cost:  one pass within layers, one up, one down; 2 bytes per point read and written in each.

namespace bccskel {
namespace {

std::vector<BrickSlab> SlabsOf(const Volume& object) {
  std::vector<BrickSlab> slabs;
  const std::span<const BrickKey> keys = object.keys();
  for (BrickIndex n = 0; n < keys.size(); ++n) {
    const BrickCoordinates brick = keys[n].coordinates();
    if (n == 0 || brick.bz != keys[n - 1].coordinates().bz) slabs.push_back({n, n, {}});
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
        // A slab is still in the cache when it is raised.
        if (alone) SweepWithinLayers(view_, slab.first, slab.last);
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
  // In the unit of Context::WorkersFor(): workers that sweep take whole slabs, others meet after
  // each layer of a slab, where they have nearly the same to do.
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
    exec::Portions portions(slabs_.size(), 1);
    context_.Offer(workers, [&](int) {
      for (exec::Share next = portions.Take(); next.begin < next.end && !context_.ShouldStop();
           next = portions.Take()) {
        SweepWithinLayers(view_, slabs_[next.begin].first, slabs_[next.begin].last);
      }
    });
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

  // Layers follow each other, so the workers meet after each.
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

// Of a section, where an object has several; a slab with more is one all the same.
constexpr size_t kSectionPoints = size_t{1} << 22;

// Scans an object section by section: all from below, where each leaves its top layer, then all
// from above, where each but the last is scanned from below once more.
template <typename T>
class Stream {
 public:
  Stream(const Volume& object, const ChamferWeights& weights, const RunTables* runs,
         const exec::Context& context, size_t at_once)
      : object_(object),
        weights_(weights),
        runs_(runs),
        context_(context),
        slabs_(SlabsOf(object)) {
    const bool all_at_once = object.brick_count() * kBrickPoints <= at_once;
    const size_t most = all_at_once ? at_once : std::min(at_once, kSectionPoints);
    size_t points = 0;
    for (size_t s = 0; s < slabs_.size(); ++s) {
      if (points == 0 || points + slabs_[s].size() * kBrickPoints > most) {
        starts_.push_back(s);
        points = 0;
      }
      points += slabs_[s].size() * kBrickPoints;
    }
    starts_.push_back(slabs_.size());
  }

  // Returns the largest distance, or one that is not below `limit` and then was too large.
  absl::StatusOr<uint32_t> Run(uint32_t limit, DistanceSink& sink) {
    for (size_t n = 0; n + 1 < sections(); ++n) {
      tops_.push_back(Risen(n).TopLayer());
      BCCSKEL_RETURN_IF_ERROR(context_.StopStatus());
    }
    std::atomic<uint32_t> largest = 0;
    for (size_t n = sections(); n-- > 0 && largest < limit;) {
      Finish(n, sink, largest);
      BCCSKEL_RETURN_IF_ERROR(context_.StopStatus());
    }
    return largest.load();
  }

 private:
  using Layer = typename ChamferSection<T>::Layer;

  size_t sections() const { return starts_.size() - 1; }

  ChamferSection<T> Risen(size_t n) const {
    ChamferSection<T> section(object_, slabs_, starts_[n], starts_[n + 1]);
    if (n > 0) section.SetLayerBelow(tops_[n - 1]);
    SectionScan<T>(section, weights_, runs_, context_).Rise();
    return section;
  }

  void Finish(size_t n, DistanceSink& sink, std::atomic<uint32_t>& largest) {
    ChamferSection<T> section = Risen(n);
    if (n + 1 < sections()) section.SetLayerAbove(bottom_);
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
    bottom_ = section.BottomLayer();
  }

  const Volume& object_;
  const ChamferWeights weights_;
  const RunTables* const runs_;
  const exec::Context& context_;
  const std::vector<BrickSlab> slabs_;
  std::vector<size_t> starts_;  // of the sections, and the end
  std::vector<Layer> tops_;     // of the sections, as seen from below
  Layer bottom_;                // of the section above
};

// What a holder tells the next: the layer of bricks that the distances are of, and these.
template <typename T>
LayerRelay::Bytes PackLayer(int32_t bz, const exec::UninitializedVector<T>& layer) {
  LayerRelay::Bytes bytes(sizeof(bz) + layer.size() * sizeof(T));
  std::memcpy(bytes.data(), &bz, sizeof(bz));
  std::memcpy(bytes.data() + sizeof(bz), layer.data(), layer.size() * sizeof(T));
  return bytes;
}

// Nothing where the distances are of another layer: then none lies beside the section.
template <typename T>
std::optional<exec::UninitializedVector<T>> UnpackLayer(const LayerRelay::Bytes& bytes,
                                                        int32_t wanted) {
  int32_t bz = -1;
  if (bytes.size() < sizeof(bz)) return std::nullopt;
  std::memcpy(&bz, bytes.data(), sizeof(bz));
  if (bz != wanted) return std::nullopt;
  exec::UninitializedVector<T> layer((bytes.size() - sizeof(bz)) / sizeof(T));
  std::memcpy(layer.data(), bytes.data() + sizeof(bz), layer.size() * sizeof(T));
  return layer;
}

// Both scans over one holder's layers.
template <typename T>
exec::UninitializedVector<T> ScanLayersOfHolder(const Volume& object, int32_t first_bz,
                                                int32_t end_bz, const ChamferWeights& weights,
                                                const RunTables* runs, const exec::Context& context,
                                                LayerRelay& relay) {
  const std::vector<BrickSlab> slabs = SlabsOf(object);
  const auto bz_of = [&](size_t slab) { return object.keys()[slabs[slab].first].coordinates().bz; };
  size_t first = 0, last = slabs.size();
  while (first < last && bz_of(first) < first_bz) ++first;
  while (last > first && bz_of(last - 1) >= end_bz) --last;
  exec::UninitializedVector<T> values((object.brick_count() + 1) * kBrickPoints);
  std::ranges::fill(values, T{0});
  if (first == last) {
    relay.GiveAbove(relay.TakeFromBelow());
    relay.GiveBelow(relay.TakeFromAbove());
    return values;
  }
  ChamferSection<T> section(object, slabs, first, last);
  const SectionScan<T> scan(section, weights, runs, context);
  const auto below = UnpackLayer<T>(relay.TakeFromBelow(), first > 0 ? bz_of(first - 1) : -2);
  if (below.has_value()) section.SetLayerBelow(*below);
  scan.Rise();
  relay.GiveAbove(PackLayer(bz_of(last - 1), section.TopLayer()));
  const auto above = UnpackLayer<T>(relay.TakeFromAbove(), last < slabs.size() ? bz_of(last) : -2);
  if (above.has_value()) section.SetLayerAbove(*above);
  scan.Fall([](BrickIndex, BrickIndex) {});
  relay.GiveBelow(PackLayer(bz_of(first), section.BottomLayer()));
  for (BrickIndex n = slabs[first].first; n < slabs[last - 1].last; ++n) {
    std::copy_n(section.Of(n - section.start()), kBrickPoints,
                values.data() + size_t{n} * kBrickPoints);
  }
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

DistanceField ComputeChamferOfLayers(const Volume& object, int32_t first, int32_t end,
                                     DistanceKind kind, const exec::Context& context,
                                     LayerRelay& relay) {
  const AxisScale scale = AxisScaleOf(object.placement());
  const ChamferWeights weights = ShortWeights(scale);
  if (FitShortRows(weights)) {
    const RunTables runs = RunTablesOf(weights);
    auto values = ScanLayersOfHolder<uint16_t>(object, first, end, weights, &runs, context, relay);
    const uint32_t largest = relay.Largest(LargestOf(std::span<const uint16_t>(values)));
    if (largest < runs.limit()) {
      return DistanceField(kind, InUnitOf(kind, weights, scale), std::move(values), largest);
    }
  }
  const ChamferWeights wide = LongWeights(scale);
  auto values = ScanLayersOfHolder<uint32_t>(object, first, end, wide, nullptr, context, relay);
  const uint32_t largest = relay.Largest(LargestOf(std::span<const uint32_t>(values)));
  return DistanceField(kind, InUnitOf(kind, wide, scale), std::move(values), largest);
}

absl::Status StreamChamfer(const Volume& object, DistanceKind kind, const exec::Context& context,
                           DistanceSink& sink, size_t at_once) {
  const AxisScale scale = AxisScaleOf(object.placement());
  const ChamferWeights weights = ShortWeights(scale);
  if (FitShortRows(weights)) {
    const RunTables runs = RunTablesOf(weights);
    sink.Begin(InUnitOf(kind, weights, scale), runs.limit());
    Stream<uint16_t> stream(object, weights, &runs, context, at_once);
    BCCSKEL_ASSIGN_OR_RETURN(const uint32_t largest, stream.Run(runs.limit(), sink));
    if (largest < runs.limit()) return absl::OkStatus();
  }
  const ChamferWeights wide = LongWeights(scale);
  sink.Begin(InUnitOf(kind, wide, scale), UINT32_MAX);
  Stream<uint32_t> stream(object, wide, nullptr, context, at_once);
  return stream.Run(UINT32_MAX, sink).status();
}

}  // namespace bccskel
