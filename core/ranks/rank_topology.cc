#include "core/ranks/rank_topology.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/certificate/component_sets.h"
#include "core/exec/status_macros.h"
#include "core/exec/union_find.h"
#include "core/ranks/agreement.h"
#include "core/ranks/layer_owners.h"
#include "core/ranks/packing.h"

namespace bccskel::ranks {
namespace {

Volume OnlyLayers(const Volume& volume, int32_t first, int32_t last) {
  const exec::Share share = BricksOfLayers(volume, first, last + 1);
  const auto keys = volume.keys().subspan(share.begin, share.end - share.begin);
  const auto bricks = volume.bricks().subspan(share.begin, share.end - share.begin);
  return Volume::FromSortedBricks(volume.extent(), volume.placement(), {keys.begin(), keys.end()},
                                  {bricks.begin(), bricks.end()});
}

// A component of a rank.
struct Named {
  uint64_t rank = 0;
  uint64_t set = 0;

  friend auto operator<=>(const Named&, const Named&) = default;
};
// A component of the rank below and the same component on this rank.
struct Glued {
  Named below;
  Named here;

  friend auto operator<=>(const Glued&, const Glued&) = default;
};

// The number of joins that the pairs make.
uint64_t CountJoined(const std::vector<Glued>& pairs) {
  std::vector<Named> names;
  for (const auto& [a, b] : pairs) names.insert(names.end(), {a, b});
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  const auto place_of = [&](const Named& name) {
    return static_cast<size_t>(std::ranges::lower_bound(names, name) - names.begin());
  };
  UnionFind<size_t> sets(names.size());
  uint64_t joined = 0;
  for (const auto& [a, b] : pairs) joined += sets.Unite(place_of(a), place_of(b)) ? 1 : 0;
  return joined;
}

// The layers of a rank, and the layer above them, the lowest of the next rank.
class LabeledLayers {
 public:
  LabeledLayers(Exchange& exchange, const RankBricks& bricks)
      : exchange_(exchange), owners_(exchange, bricks.local, bricks.own) {
    const Volume beside = MoveToLayers(exchange, owners_, bricks.local, bricks.own);
    first_ = owners_.FirstOf(exchange.rank());
    end_ = owners_.EndOf(exchange.rank());
    const int32_t layers = owners_.count();
    has_layers_ = first_ < end_;
    if (has_layers_ && first_ > 0) below_ = static_cast<int>(owners_.RankOf(first_ - 1));
    if (has_layers_ && end_ < layers) above_ = static_cast<int>(owners_.RankOf(end_));
    volume_ = has_layers_ ? OnlyLayers(beside, first_, end_) : OnlyLayers(beside, 0, -1);
  }

  // The Euler characteristic of this part, without the layer that the next rank also counts.
  uint64_t Euler(const exec::Context& context) const {
    const int64_t all = CountEulerCharacteristic(volume_, context);
    const Volume shared = OnlyLayers(volume_, end_, end_);
    return static_cast<uint64_t>(all - CountEulerCharacteristic(shared, context));
  }

  // The number of components of all ranks, on rank 0.
  int64_t CountComponents(Phase phase, const exec::Context& context) {
    std::optional<ComponentSets> sets;
    if (has_layers_) {
      constexpr int32_t kFar = std::numeric_limits<int32_t>::max();
      sets.emplace(volume_, phase, context,
                   KnownLayers{below_ < 0 ? -kFar : first_, above_ < 0 ? kFar : end_});
    }
    uint64_t count = sets.has_value() ? static_cast<uint64_t>(sets->count()) : 0;
    exchange_.Sum({&count, 1});
    Bytes pairs;
    Pack(std::span<const Glued>(Glue(phase, sets)), pairs);
    std::vector<Glued> all;
    for (const Bytes& letter : Gather(exchange_, std::move(pairs))) {
      const std::vector<Glued> some = Unpacker(letter).TakeRest<Glued>();
      all.insert(all.end(), some.begin(), some.end());
    }
    return static_cast<int64_t>(count - CountJoined(all));
  }

 private:
  // The components of a layer's pieces, in an order that is the same on all ranks.
  static std::vector<uint64_t> SetsOfLayer(const Volume& volume, int32_t layer, Phase phase,
                                           ComponentSets& sets) {
    std::vector<uint64_t> found;
    const auto add = [&](size_t set) { found.push_back(set); };
    for (BrickIndex n = 0; n < volume.brick_count(); ++n) {
      if (volume.keys()[n].coordinates().bz != layer || !sets.pieces().HasPoints(n)) continue;
      add(sets.SetOf(n));
      const BrickFragments* split = sets.pieces().fragments(n);
      if (split == nullptr) continue;
      for (int c = 1; c < split->components; ++c) {
        add(sets.SetOf(split->first_number + static_cast<size_t>(c) - 1));
      }
    }
    if (phase == Phase::kObject) return found;
    for (size_t place = 0; place < sets.gaps().place_count(); ++place) {
      const std::optional<BackgroundGaps::Gap> gap = sets.gaps().GapBefore(place);
      if (gap.has_value() && gap->first.bz == layer) add(sets.SetOfGap(gap->node));
    }
    add(sets.SetOfGap(BackgroundGaps::kOutside));
    return found;
  }

  // The components of the rank below that continue in this rank's.
  std::vector<Glued> Glue(Phase phase, std::optional<ComponentSets>& sets) {
    std::vector<int> peers;
    std::vector<Bytes> out;
    if (below_ >= 0) {
      peers.push_back(below_);
      out.emplace_back();
    }
    if (above_ >= 0) {
      peers.push_back(above_);
      Pack(std::span<const uint64_t>(SetsOfLayer(volume_, end_, phase, *sets)), out.emplace_back());
    }
    std::vector<Bytes> in(peers.size());
    exchange_.Trade(peers, out, in);
    std::vector<Glued> pairs;
    if (below_ < 0) return pairs;
    const std::vector<uint64_t> theirs = Unpacker(in.front()).TakeRest<uint64_t>();
    const std::vector<uint64_t> own = SetsOfLayer(volume_, first_, phase, *sets);
    // The same number on both, unless one of the two was stopped.
    for (size_t n = 0; n < std::min(own.size(), theirs.size()); ++n) {
      pairs.push_back({{static_cast<uint64_t>(below_), theirs[n]},
                       {static_cast<uint64_t>(exchange_.rank()), own[n]}});
    }
    std::ranges::sort(pairs);
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  }

  Exchange& exchange_;
  const LayerOwners owners_;
  Volume volume_;
  int32_t first_ = 0;
  int32_t end_ = 0;
  bool has_layers_ = false;
  int below_ = -1;  // the rank of the next lower layer; -1: none
  int above_ = -1;
};

}  // namespace

absl::StatusOr<BettiNumbers> CountBettiNumbersOverRanks(Exchange& exchange,
                                                        const RankBricks& bricks,
                                                        const exec::Context& context) {
  LabeledLayers layers(exchange, bricks);
  BettiNumbers betti;
  betti.components = layers.CountComponents(Phase::kObject, context);
  betti.cavities = layers.CountComponents(Phase::kBackground, context) - 1;
  uint64_t euler = layers.Euler(context);
  exchange.Sum({&euler, 1});
  betti.loops = betti.components + betti.cavities - static_cast<int64_t>(euler);
  BCCSKEL_RETURN_IF_ERROR(AgreeToGoOn(exchange, context));
  return betti;
}

}  // namespace bccskel::ranks
