#include "core/ranks/rank_peeling.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "core/exec/stage_clock.h"
#include "core/exec/status_macros.h"
#include "core/ranks/border_partners.h"
#include "core/ranks/packing.h"
#include "core/ranks/rank_bricks.h"
#include "core/ranks/rank_shells.h"
#include "core/thinning/cleanup.h"
#include "core/thinning/direction_rule.h"
#include "core/thinning/shell_sweep.h"
#include "core/thinning/symmetric_rule.h"
#include "core/thinning/thinning_state.h"

namespace bccskel::ranks {
namespace {

// What is left of the object when the shells are done, of all ranks.
struct Remains {
  std::vector<BrickKey> keys;
  std::vector<BrickBits> object;
  std::vector<BrickBits> candidates;
  std::vector<IsthmusBirth> isthmuses;
};

class Peeling {
 public:
  Peeling(Exchange& exchange, DistanceKind distance, const ThinningOptions& options,
          const exec::Context& context)
      : exchange_(exchange), distance_(distance), options_(options), context_(context) {}

  absl::StatusOr<ThinningResult> Run(const Volume& part) && {
    const RankBricks bricks = AddGhosts(exchange_, ShareEvenly(exchange_, part));
    BCCSKEL_ASSIGN_OR_RETURN(
        const RankShells shells,
        MeasureShells(exchange_, bricks, distance_, options_.shell_width,
                      IsSymmetric() ? Depths::kWanted : Depths::kNone, context_));
    result_.times.shells = clock_.Lap();
    result_.last_shell = shells.shells.last();
    ThinningState state(bricks.local, options_.keep);
    BCCSKEL_RETURN_IF_ERROR(Sweep(bricks, shells, state));
    Remains remains = Collect(bricks, state);
    result_.times.passes = clock_.Lap();
    if (exchange_.rank() == 0) BCCSKEL_RETURN_IF_ERROR(Finish(part, std::move(remains)));
    return std::move(result_);
  }

 private:
  bool IsSymmetric() const { return options_.method == ThinningMethod::kSymmetric; }

  absl::Status Sweep(const RankBricks& bricks, const RankShells& shells, ThinningState& state) {
    if (IsSymmetric()) {
      SymmetricRule rule(shells.depths, options_.kind, state);
      BCCSKEL_RETURN_IF_ERROR(Sweep(bricks, shells.shells, rule, state));
      isthmuses_ = rule.Isthmuses();
      return absl::OkStatus();
    }
    const bool alternating = options_.method == ThinningMethod::kDirectionalAlternating;
    DirectionRule rule(state, alternating ? DirectionOrder::kAlternating : DirectionOrder::kSame);
    return Sweep(bricks, shells.shells, rule, state);
  }

  absl::Status Sweep(const RankBricks& bricks, const Shells& shells, PassRule& rule,
                     ThinningState& state) {
    BorderPartners partners(exchange_, bricks);
    const SweepPlan plan = {.shells = shells,
                            .last = LastShellOf(options_, shells),
                            .stubble = StubbleOf(options_),
                            .partners = &partners};
    BCCSKEL_ASSIGN_OR_RETURN(const SweepTotals totals, SweepShells(plan, rule, context_, state));
    result_.removed = totals.removed;
    result_.passes = totals.passes;
    return absl::OkStatus();
  }

  // Isthmuses of ghosts are their owners'.
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

  // Little is left, so rank 0 cleans up alone.
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
  const exec::Context& context_;
  exec::StageClock clock_;
  std::vector<IsthmusBirth> isthmuses_;
  ThinningResult result_;
};

}  // namespace

absl::StatusOr<ThinningResult> PeelOverRanks(Exchange& exchange, const Volume& part,
                                             DistanceKind distance, const ThinningOptions& options,
                                             const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckThinningOptions(options));
  return Peeling(exchange, distance, options, context).Run(part);
}

}  // namespace bccskel::ranks
