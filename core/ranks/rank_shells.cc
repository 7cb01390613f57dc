#include "core/ranks/rank_shells.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "core/distance/chamfer_scan.h"
#include "core/distance/chamfer_weights.h"
#include "core/distance/euclidean_parts.h"
#include "core/exec/large_blocks.h"
#include "core/exec/status_macros.h"
#include "core/ranks/agreement.h"
#include "core/ranks/layer_owners.h"
#include "core/ranks/packing.h"
#include "core/ranks/shell_store.h"

namespace bccskel::ranks {
namespace {

// Squares of a round of columns that a rank gets.
constexpr size_t kBytesPerRound = size_t{8} << 20;

uint64_t ColumnHash(const BrickCoordinates& at) {
  uint64_t hash = static_cast<uint64_t>(at.by) << 32 | static_cast<uint64_t>(at.bx);
  hash = (hash ^ hash >> 31) * 0x9e3779b97f4a7c15;
  hash = (hash ^ hash >> 29) * 0xbf58476d1ce4e5b9;
  return hash ^ hash >> 32;
}

// Bricks of layers, sorted into the columns that are measured together: in `rounds` rounds, one
// after the other, each rank measures some columns.
class ColumnRounds {
 public:
  ColumnRounds(Exchange& exchange, const LayerOwners& layers, const Volume& volume,
               size_t bytes_per_brick)
      : ranks_(static_cast<size_t>(exchange.size())) {
    uint64_t bricks = volume.brick_count();
    exchange.Max({&bricks, 1});
    rounds_ = bricks * bytes_per_brick / kBytesPerRound + 1;
    starts_.resize(rounds_ * ranks_ + 1);
    const auto own_rank = static_cast<size_t>(exchange.rank());
    std::vector<std::pair<size_t, BrickIndex>> slots;
    for (BrickIndex n = 0; n < volume.brick_count(); ++n) {
      const BrickCoordinates at = volume.keys()[n].coordinates();
      if (layers.RankOf(at.bz) != own_rank) continue;  // of the layer below or above
      slots.emplace_back(ColumnHash(at) % (rounds_ * ranks_), n);
    }
    std::ranges::sort(slots);
    bricks_.reserve(slots.size());
    for (const auto& [slot, n] : slots) {
      ++starts_[slot + 1];
      bricks_.push_back(n);
    }
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  }

  size_t rounds() const { return rounds_; }
  // In the order of their keys.
  std::span<const BrickIndex> BricksFor(size_t round, size_t rank) const {
    const size_t slot = round * ranks_ + rank;
    return std::span(bricks_).subspan(starts_[slot], starts_[slot + 1] - starts_[slot]);
  }

 private:
  size_t ranks_;
  size_t rounds_ = 1;
  std::vector<size_t> starts_;
  std::vector<BrickIndex> bricks_;
};

// The rounds of an object's columns.
template <typename T>
class EuclideanRounds {
 public:
  EuclideanRounds(Exchange& exchange, const RankBricks& bricks, const exec::Context& context,
                  ShellStore& store)
      : exchange_(exchange), bricks_(bricks), context_(context), store_(store) {}

  // Errors: OUT_OF_RANGE where T is too small for the distances of the object.
  absl::Status Run(const LayerOwners& layers, const Volume& volume) {
    EuclideanParts<T> parts(volume.brick_count());
    MeasureWithinLayers(volume, SideRunsOf(volume, context_), context_, parts);
    const ColumnRounds columns(exchange_, layers, volume, kSquares * sizeof(T));
    for (size_t round = 0; round < columns.rounds(); ++round) {
      BCCSKEL_RETURN_IF_ERROR(AgreeToGoOn(exchange_, context_));
      const uint64_t largest = Measure(columns, round, volume, parts);
      if (sizeof(T) == sizeof(uint16_t) && largest >= kFirstUnsureSquare) {
        return absl::OutOfRangeError("deeper than 16 bits");
      }
    }
    return absl::OkStatus();
  }

 private:
  static constexpr size_t kBeside = kLayersBeside * kLayerPoints;
  static constexpr size_t kSquares = kBrickPoints + kBeside;

  // Returns the largest square of the round, of all ranks.
  uint64_t Measure(const ColumnRounds& columns, size_t round, const Volume& volume,
                   const EuclideanParts<T>& parts) {
    std::vector<Bytes> out(static_cast<size_t>(exchange_.size()));
    for (size_t rank = 0; rank < out.size(); ++rank) {
      for (const BrickIndex n : columns.BricksFor(round, rank)) {
        PackBrick(volume.keys()[n], volume.bricks()[n], out[rank]);
        Pack(std::span(parts.own).subspan(size_t{n} * kBrickPoints, kBrickPoints), out[rank]);
        Pack(std::span(parts.beside).subspan(size_t{n} * kBeside, kBeside), out[rank]);
      }
    }
    uint64_t largest = MeasureColumns(TradeWithAll(exchange_, std::move(out)));
    exchange_.Max({&largest, 1});
    return largest;
  }

  uint64_t MeasureColumns(std::vector<Bytes> in) {
    std::vector<BrickKey> keys;
    std::vector<BrickBits> bits;
    size_t count = 0;
    for (const Bytes& letter : in) {
      count += letter.size() / (sizeof(BrickKey) + sizeof(BrickBits) + kSquares * sizeof(T));
    }
    EuclideanParts<T> parts(count);
    for (Bytes& letter : in) {
      for (Unpacker from(letter); !from.done();) {
        const size_t n = keys.size();
        TakeBrick(from, keys, bits);
        from.Take(std::span(parts.own).subspan(n * kBrickPoints, kBrickPoints));
        from.Take(std::span(parts.beside).subspan(n * kBeside, kBeside));
      }
      letter = {};
    }
    const Volume columns = Volume::FromSortedBricks(
        bricks_.local.extent(), bricks_.local.placement(), std::move(keys), std::move(bits));
    MeasureAcrossLayers(columns, context_, parts);
    const DistanceField field = EuclideanFieldOf(std::move(parts));
    store_.Trade(columns, {0, columns.brick_count()}, field, context_);
    return field.largest();
  }

  Exchange& exchange_;
  const RankBricks& bricks_;
  const exec::Context& context_;
  ShellStore& store_;
};

absl::Status MeasureEuclidean(Exchange& exchange, const RankBricks& bricks,
                              const LayerOwners& layers, const Volume& volume,
                              const exec::Context& context, ShellStore& store) {
  uint64_t is_deep = IsDeep(volume) ? 1 : 0;
  exchange.Max({&is_deep, 1});
  if (AxisScaleOf(volume.placement()) == kIsotropic && is_deep == 0) {
    EuclideanRounds<uint16_t> rounds(exchange, bricks, context, store);
    const absl::Status done = rounds.Run(layers, volume);
    if (!absl::IsOutOfRange(done)) return done;
  }
  return EuclideanRounds<float>(exchange, bricks, context, store).Run(layers, volume);
}

// Ranks are holders in their order.
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

absl::Status MeasureChamfer(Exchange& exchange, const LayerOwners& layers, const Volume& volume,
                            DistanceKind kind, const exec::Context& context, ShellStore& store) {
  RankRelay relay(exchange);
  const int32_t first = layers.FirstOf(exchange.rank()), end = layers.EndOf(exchange.rank());
  const DistanceField field = ComputeChamferOfLayers(volume, first, end, kind, context, relay);
  BCCSKEL_RETURN_IF_ERROR(AgreeToGoOn(exchange, context));
  const auto index_of = [&](int32_t layer) {
    const auto at = std::ranges::lower_bound(volume.keys(), layer, {},
                                             [](BrickKey key) { return key.coordinates().bz; });
    return static_cast<size_t>(at - volume.keys().begin());
  };
  store.Trade(volume, {index_of(first), index_of(end)}, field, context);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<RankShells> MeasureShells(Exchange& exchange, const RankBricks& bricks,
                                         DistanceKind kind, double shell_width, Depths depths,
                                         const exec::Context& context) {
  ShellStore store(exchange, bricks, shell_width, depths);
  {
    const LayerOwners layers(exchange, bricks.local, bricks.own);
    const Volume volume = MoveToLayers(exchange, layers, bricks.local, bricks.own);
    BCCSKEL_RETURN_IF_ERROR(kind == DistanceKind::kEuclidean
                                ? MeasureEuclidean(exchange, bricks, layers, volume, context, store)
                                : MeasureChamfer(exchange, layers, volume, kind, context, store));
  }
  // A rank thins for long and measures once, so blocks of squares are not kept for another time.
  exec::ProcessLargeBlocks().ReleaseUnused();
  exec::ProcessLargeBlocks().ReleaseUnused();
  return std::move(store).Finish();
}

}  // namespace bccskel::ranks
