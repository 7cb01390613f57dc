#include "core/ranks/rank_shells.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/distance/chamfer_scan.h"
#include "core/distance/chamfer_weights.h"
#include "core/distance/euclidean_parts.h"
#include "core/exec/huge_pages.h"
#include "core/exec/large_blocks.h"
#include "core/exec/status_macros.h"
#include "core/ranks/agreement.h"
#include "core/ranks/layer_owners.h"
#include "core/ranks/packing.h"
#include "core/ranks/shell_store.h"

namespace bccskel::ranks {
namespace {

// The squares within layers that a rank holds for the columns of a round, or more if the object is
// large across x; and about as many that it sends and measures across layers in a turn.
constexpr size_t kBytesPerRound = size_t{2} << 20, kBytesPerTurn = size_t{1} << 20;

// The rank and the turn in which a column is measured.
struct Measurer {
  size_t rank;
  size_t turn;
};

// Consecutive columns along y go to different ranks in the same turn, starting with a pseudorandom
// one, so that neither solids nor patterns give some ranks more work.
Measurer MeasurerOf(BrickKey key, size_t ranks, size_t turns) {
  const BrickCoordinates at = key.coordinates();
  const auto by = static_cast<uint64_t>(at.by);
  uint64_t hash = by / ranks << 32 | static_cast<uint64_t>(at.bx);
  hash = (hash ^ hash >> 31) * 0x9e3779b97f4a7c15;
  hash = (hash ^ hash >> 29) * 0xbf58476d1ce4e5b9;
  return {(by + (hash ^ hash >> 32)) % ranks, by / ranks % turns};
}

// Measures columns round by round, so that few squares exist at a time: in turns, those of a round
// go from the ranks with their layers to the ranks with their columns.
class EuclideanRounds {
 public:
  EuclideanRounds(Exchange& exchange, const RankBricks& bricks, const LayerOwners& layers,
                  const exec::Context& context, ShellStore& store)
      : exchange_(exchange),
        bricks_(bricks),
        layers_(layers),
        context_(context),
        store_(store),
        ranks_(static_cast<size_t>(exchange.size())),
        may_be_whole_(AxisScaleOf(bricks.local.placement()) == kIsotropic) {}

  absl::Status Run() {
    const Volume volume = MoveToLayers(exchange_, layers_, bricks_.local, bricks_.own);
    std::vector<uint64_t> counts = BricksAtX(volume);
    exchange_.Max(counts);
    for (const auto& group : ColumnsOf(volume, counts, kBytesPerRound / kBytes<uint16_t>)) {
      BCCSKEL_RETURN_IF_ERROR(AgreeToGoOn(exchange_, context_));
      const ObjectPart part = PartOf(volume, group, context_);
      // Columns beside deep ones are usually deep, too.
      if (may_be_whole_ && largest_ < kFirstUnsureSquare && MeasureAs<uint16_t>(part)) continue;
      MeasureAs<float>(part);
    }
    return absl::OkStatus();
  }

 private:
  static constexpr size_t kBeside = kLayersBeside * kLayerPoints;
  template <typename T>
  static constexpr size_t kBytes = sizeof(BrickKey) + sizeof(BrickBits) +
                                   (kBrickPoints + kBeside) * sizeof(T);

  // Returns whether T was enough, on all ranks.
  template <typename T>
  bool MeasureAs(const ObjectPart& part) {
    const exec::Share own = BricksOfLayers(part.volume, layers_.FirstOf(exchange_.rank()),
                                           layers_.EndOf(exchange_.rank()));
    uint64_t most = own.end - own.begin;
    exchange_.Max({&most, 1});
    const size_t turns = most * kBytes<T> / kBytesPerTurn + 1;
    EuclideanParts<T> parts(part.volume.brick_count());
    MeasureWithinLayers(part.volume, own, part.runs, context_, parts);
    largest_ = 0;
    for (size_t turn = 0; turn < turns; ++turn) {
      MeasureColumns<T>(TradeWithAll(exchange_, PackColumns(part.volume, own, parts, turn, turns)));
      exchange_.Max({&largest_, 1});
      if (sizeof(T) == sizeof(uint16_t) && largest_ >= kFirstUnsureSquare) return false;
      store_.SendAway(columns_);
    }
    return true;
  }

  // The squares of this rank's layers for the ranks that measure columns in this turn.
  template <typename T>
  std::vector<Bytes> PackColumns(const Volume& volume, exec::Share own,
                                 const EuclideanParts<T>& parts, size_t turn, size_t turns) const {
    std::vector<std::vector<BrickIndex>> bricks(ranks_);
    for (size_t n = own.begin; n < own.end; ++n) {
      const Measurer measurer = MeasurerOf(volume.keys()[n], ranks_, turns);
      if (measurer.turn == turn) bricks[measurer.rank].push_back(static_cast<BrickIndex>(n));
    }
    std::vector<Bytes> letters(ranks_);
    for (size_t rank = 0; rank < ranks_; ++rank) {
      letters[rank].reserve(bricks[rank].size() * kBytes<T>);
      for (const size_t n : bricks[rank]) {
        PackBrick(volume.keys()[n], volume.bricks()[n], letters[rank]);
        Pack(std::span(parts.own).subspan(n * kBrickPoints, kBrickPoints), letters[rank]);
        Pack(std::span(parts.beside).subspan(n * kBeside, kBeside), letters[rank]);
      }
    }
    return letters;
  }

  template <typename T>
  void MeasureColumns(std::vector<Bytes> in) {
    std::vector<BrickKey> keys;
    std::vector<BrickBits> bits;
    size_t count = 0;
    for (const Bytes& letter : in) count += letter.size() / kBytes<T>;
    EuclideanParts<T> parts(count);
    keys.reserve(count);
    bits.reserve(count + 1);  // Volume adds one
    for (Bytes& letter : in) {
      for (Unpacker from(letter); !from.done();) {
        const size_t n = keys.size();
        TakeBrick(from, keys, bits);
        from.Take(std::span(parts.own).subspan(n * kBrickPoints, kBrickPoints));
        from.Take(std::span(parts.beside).subspan(n * kBeside, kBeside));
      }
      letter = {};
    }
    columns_ = Volume::FromSortedBricks(bricks_.local.extent(), bricks_.local.placement(),
                                        std::move(keys), std::move(bits));
    store_.Expect(columns_, {0, columns_.brick_count()});
    SquareSlicer slicer = store_.Slicer();
    const float largest = MeasureAcrossLayers<T>(columns_, context_, parts, [&](BrickStack stack) {
      for (const BrickIndex n : stack) {
        slicer.Take(n, parts.own.data() + size_t{n} * kBrickPoints);
      }
    });
    largest_ = std::max(largest_, static_cast<uint64_t>(largest));
  }

  Exchange& exchange_;
  const RankBricks& bricks_;
  const LayerOwners& layers_;
  const exec::Context& context_;
  ShellStore& store_;
  const size_t ranks_;
  const bool may_be_whole_;
  Volume columns_;        // of this turn
  uint64_t largest_ = 0;  // largest square of the last round
};

// The ranks are the holders, in order.
class RankRelay : public LayerRelay {
 public:
  explicit RankRelay(Exchange& exchange) : exchange_(exchange) {}

  Bytes TakeFromBelow() override { return Swap(exchange_.rank() - 1, {}); }
  void GiveAbove(const Bytes& layer) override { Swap(exchange_.rank() + 1, layer); }
  Bytes TakeFromAbove() override { return Swap(exchange_.rank() + 1, {}); }
  void GiveBelow(const Bytes& layer) override { Swap(exchange_.rank() - 1, layer); }
  uint32_t Largest(uint32_t own) override {
    uint64_t largest = own;
    exchange_.Max({&largest, 1});
    return static_cast<uint32_t>(largest);
  }

 private:
  Bytes Swap(int peer, const Bytes& out) {
    Bytes in;
    if (peer >= 0 && peer < exchange_.size()) exchange_.Trade({&peer, 1}, {&out, 1}, {&in, 1});
    return in;
  }

  Exchange& exchange_;
};

absl::Status MeasureChamfer(Exchange& exchange, const RankBricks& bricks, const LayerOwners& layers,
                            DistanceKind kind, double shell_width, const exec::Context& context,
                            ShellStore& store) {
  const Volume volume = MoveToLayers(exchange, layers, bricks.local, bricks.own);
  RankRelay relay(exchange);
  const HeldLayers held = {layers.FirstOf(exchange.rank()), layers.EndOf(exchange.rank())};
  store.Expect(volume, BricksOfLayers(volume, held.first, held.end));
  (void)StreamShellsOfLayers(volume, held, kind, shell_width, context, relay, store.Places());
  BCCSKEL_RETURN_IF_ERROR(AgreeToGoOn(exchange, context));
  store.SendAway(volume);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<RankShells> MeasureShells(Exchange& exchange, const RankBricks& bricks,
                                         DistanceKind kind, double shell_width, Depths depths,
                                         const exec::Context& context) {
  ShellStore store(exchange, bricks, shell_width, depths);
  {
    const LayerOwners layers(exchange, bricks.local, bricks.own);
    BCCSKEL_RETURN_IF_ERROR(
        kind == DistanceKind::kEuclidean
            ? EuclideanRounds(exchange, bricks, layers, context, store).Run()
            : MeasureChamfer(exchange, bricks, layers, kind, shell_width, context, store));
  }
  // A rank measures once and then thins for long, so blocks of squares are not kept for reuse.
  exec::ProcessLargeBlocks().ReleaseUnused();
  exec::ProcessLargeBlocks().ReleaseUnused();
  return std::move(store).Finish();
}

}  // namespace bccskel::ranks
