#include "core/ranks/rank_peeling.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include "core/exec/stage_clock.h"
#include "core/exec/status_macros.h"
#include "core/ranks/agreement.h"
#include "core/ranks/border_partners.h"
#include "core/ranks/packing.h"
#include "core/ranks/rank_bricks.h"
#include "core/ranks/rank_shells.h"
#include "core/ranks/rank_topology.h"
#include "core/thinning/cleanup.h"
#include "core/thinning/direction_rule.h"
#include "core/thinning/shell_sweep.h"
#include "core/thinning/symmetric_rule.h"
#include "core/thinning/thinning_state.h"
#include "core/volume/count_points.h"

namespace bccskel::ranks {
namespace {

// The remaining object of all ranks after the shells.
struct Remains {
  std::vector<BrickKey> keys;
  std::vector<BrickBits> object;
  std::vector<BrickBits> candidates;
  std::vector<IsthmusBirth> isthmuses;
};

using OnShell = std::function<void(int32_t)>;

class Peeling {
 public:
  Peeling(Exchange& exchange, DistanceKind distance, const ThinningOptions& options,
          const CheckpointOptions& checkpoints, const exec::Context& context)
      : exchange_(exchange),
        distance_(distance),
        options_(options),
        checkpoint_options_(checkpoints),
        context_(context),
        give_up_when_told_(context.stop, [this] { give_up_.request_stop(); }) {
    context_.stop = give_up_.get_token();
  }

  absl::StatusOr<PeeledObject> Run(Volume& part) && {
    exchange_.Enter(Stage::kSharing);
    BCCSKEL_ASSIGN_OR_RETURN(Volume own, ShareEvenly(exchange_, std::exchange(part, NoneOf(part))));
    const RankBricks bricks = AddGhosts(exchange_, std::move(own));
    BCCSKEL_ASSIGN_OR_RETURN(Remains remains, PeelOwn(bricks));
    PeeledObject peeled;
    exchange_.Enter(Stage::kTopology);
    BCCSKEL_ASSIGN_OR_RETURN(peeled.topology,
                             CountBettiNumbersOverRanks(exchange_, bricks, context_));
    peeled.points = PointsIn(bricks.local.bricks(), bricks.own);
    exchange_.Sum({&peeled.points, 1});
    absl::Status finished;
    if (exchange_.rank() == 0) finished = Finish(part, std::move(remains));
    BCCSKEL_RETURN_IF_ERROR(AgreeOn(exchange_, finished));
    exchange_.Enter(Stage::kGathering);
    part = GatherBricks(exchange_, bricks.local, bricks.own);
    peeled.thinned = std::move(result_);
    return peeled;
  }

 private:
  static Volume NoneOf(const Volume& volume) {
    return Volume::FromSortedBricks(volume.extent(), volume.placement(), {}, {});
  }

  // Returns the remaining object on rank 0.
  absl::StatusOr<Remains> PeelOwn(const RankBricks& bricks) {
    exchange_.Enter(Stage::kDistances);
    BCCSKEL_ASSIGN_OR_RETURN(const RankShells shells,
                             MeasureShells(exchange_, bricks, distance_, options_.shell_width,
                                           DepthsOf(options_.method), context_));
    result_.times.shells = clock_.Lap();
    result_.last_shell = shells.shells.last();
    exchange_.Enter(Stage::kThinning);
    Checkpoints checkpoints(exchange_, bricks, checkpoint_options_, distance_, options_);
    std::vector<BrickBits> object;
    BCCSKEL_ASSIGN_OR_RETURN(ShellsDone done, checkpoints.Resume(object));
    ThinningState state(bricks.local, KeptPoints(done));
    std::ranges::copy(object, state.object.begin());
    object = {};
    isthmuses_before_ = OwnOnly(bricks, std::move(done.isthmuses));
    BCCSKEL_RETURN_IF_ERROR(Sweep(bricks, shells, checkpoints, done.shells, state));
    Remains remains = Collect(bricks, state);
    result_.times.passes = clock_.Lap();
    return remains;
  }

  bool IsSymmetric() const { return options_.method == ThinningMethod::kSymmetric; }

  // A point that became an isthmus stays for good.
  std::vector<LatticePoint> KeptPoints(const ShellsDone& done) const {
    std::vector<LatticePoint> kept = options_.keep;
    for (const IsthmusBirth& birth : done.isthmuses) kept.push_back(birth.point);
    return kept;
  }

  // Isthmuses of ghosts belong to their owners.
  static std::vector<IsthmusBirth> OwnOnly(const RankBricks& bricks,
                                           std::vector<IsthmusBirth> isthmuses) {
    std::erase_if(isthmuses, [&](const IsthmusBirth& birth) {
      const std::optional<BrickIndex> n = bricks.local.Find(BrickKey(AddressOf(birth.point).brick));
      return !n.has_value() || *n < bricks.own.begin || *n >= bricks.own.end;
    });
    return isthmuses;
  }

  absl::Status Sweep(const RankBricks& bricks, const RankShells& shells, Checkpoints& checkpoints,
                     int32_t done, ThinningState& state) {
    if (IsSymmetric()) {
      SymmetricRule rule(shells.depths, options_.kind, state);
      const auto isthmuses = [&] {
        std::vector<IsthmusBirth> all = OwnOnly(bricks, rule.Isthmuses());
        all.insert(all.end(), isthmuses_before_.begin(), isthmuses_before_.end());
        return all;
      };
      BCCSKEL_RETURN_IF_ERROR(
          Sweep(bricks, shells.shells, checkpoints, done, isthmuses, rule, state));
      isthmuses_ = isthmuses();
      return absl::OkStatus();
    }
    DirectionRule rule(state, options_.method);
    const auto no_isthmuses = [] { return std::vector<IsthmusBirth>(); };
    return Sweep(bricks, shells.shells, checkpoints, done, no_isthmuses, rule, state);
  }

  absl::Status Sweep(const RankBricks& bricks, const Shells& shells, Checkpoints& checkpoints,
                     int32_t done, const std::function<std::vector<IsthmusBirth>()>& isthmuses,
                     PassRule& rule, ThinningState& state) {
    BorderPartners partners(exchange_, bricks);
    const int32_t last = LastShellOf(options_, shells);
    absl::Status written;
    const auto write = [&](int32_t shell) {
      if (!written.ok() || shell == last) return;
      written = checkpoints.AfterShell(shell, state, isthmuses());
      if (!written.ok()) give_up_.request_stop();  // on all ranks
    };
    uint64_t removed =
        PointsIn(bricks.local.bricks(), bricks.own) - PointsIn(state.object, bricks.own);
    partners.Sum({&removed, 1});
    const SweepPlan plan = {.shells = shells,
                            .last = last,
                            .stubble = StubbleOf(options_),
                            .after_shell = checkpoints.wanted() ? OnShell(write) : nullptr,
                            .partners = &partners,
                            .done = done};
    const absl::StatusOr<SweepTotals> totals = SweepShells(plan, rule, context_, state);
    BCCSKEL_RETURN_IF_ERROR(written);
    BCCSKEL_RETURN_IF_ERROR(totals.status());
    result_.removed = removed + totals->removed;
    result_.passes = static_cast<uint32_t>(done * rule.passes_per_cycle()) + totals->passes;
    return absl::OkStatus();
  }

  static uint64_t PointsIn(std::span<const BrickBits> bricks, exec::Share share) {
    return CountPoints(bricks.subspan(share.begin, share.end - share.begin));
  }

  Remains Collect(const RankBricks& bricks, const ThinningState& state) {
    Bytes points, births;
    for (size_t n = bricks.own.begin; n < bricks.own.end; ++n) {
      if (state.object[n].Empty()) continue;
      Pack(state.keys[n], points);
      Pack(state.object[n].words, points);
      Pack(state.candidates[n].words, points);
    }
    for (const IsthmusBirth& birth : isthmuses_) {
      const std::optional<BrickIndex> n = bricks.local.Find(BrickKey(AddressOf(birth.point).brick));
      if (*n >= bricks.own.begin && *n < bricks.own.end) Pack(birth, births);
    }
    Remains remains;
    for (const Bytes& letter : Gather(exchange_, std::move(points))) {
      for (Unpacker from(letter); !from.done();) {
        remains.keys.push_back(from.Take<BrickKey>());
        from.Take(std::span(remains.object.emplace_back().words));
        from.Take(std::span(remains.candidates.emplace_back().words));
      }
    }
    for (const Bytes& letter : Gather(exchange_, std::move(births))) {
      for (Unpacker from(letter); !from.done();) {
        remains.isthmuses.push_back(from.Take<IsthmusBirth>());
      }
    }
    return remains;
  }

  // Few points remain, so rank 0 cleans up alone.
  absl::Status Finish(const Volume& part, Remains remains) {
    result_.isthmuses = std::move(remains.isthmuses);
    std::ranges::sort(result_.isthmuses, {}, &IsthmusBirth::point);
    result_.thin = Volume::FromSortedBricks(part.extent(), part.placement(),
                                            std::move(remains.keys), std::move(remains.object));
    if (IsSymmetric() || options_.cleanup == ThinnessCleanup::kOff) return absl::OkStatus();
    ThinningState state(result_.thin, {});
    std::ranges::copy(remains.candidates, state.candidates.begin());
    BCCSKEL_ASSIGN_OR_RETURN(result_.removed_by_cleanup, CleanUpThinness(context_, state));
    result_.thin = std::move(state).ToVolume(result_.thin);
    result_.times.cleanup = clock_.Lap();
    return absl::OkStatus();
  }

  Exchange& exchange_;
  const DistanceKind distance_;
  const ThinningOptions& options_;
  const CheckpointOptions& checkpoint_options_;
  exec::Context context_;
  std::stop_source give_up_;
  std::stop_callback<std::function<void()>> give_up_when_told_;
  exec::StageClock clock_;
  std::vector<IsthmusBirth> isthmuses_before_;  // of own bricks, from a checkpoint
  std::vector<IsthmusBirth> isthmuses_;         // of own bricks
  ThinningResult result_;
};

}  // namespace

absl::StatusOr<PeeledObject> PeelOverRanks(Exchange& exchange, Volume& part, DistanceKind distance,
                                           const ThinningOptions& options,
                                           const CheckpointOptions& checkpoints,
                                           const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckThinningOptions(options));
  return Peeling(exchange, distance, options, checkpoints, context).Run(part);
}

}  // namespace bccskel::ranks
