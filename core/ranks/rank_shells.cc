#include "core/ranks/rank_shells.h"

#include <algorithm>
#include <iterator>
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

// Squares of a round of columns that a rank gets.
constexpr size_t kBytesPerRound = size_t{8} << 20;

uint64_t ColumnHash(const BrickCoordinates& at) {
  uint64_t hash = static_cast<uint64_t>(at.by) << 32 | static_cast<uint64_t>(at.bx);
  hash = (hash ^ hash >> 31) * 0x9e3779b97f4a7c15;
  hash = (hash ^ hash >> 29) * 0xbf58476d1ce4e5b9;
  return hash ^ hash >> 32;
}

// Which columns are measured together: in `count` rounds, one after the other, each rank measures
// some columns.
struct ColumnRounds {
  ColumnRounds(Exchange& exchange, const Volume& volume, size_t bytes_per_brick)
      : ranks(static_cast<size_t>(exchange.size())) {
    uint64_t bricks = volume.brick_count();
    exchange.Max({&bricks, 1});
    count = bricks * bytes_per_brick / kBytesPerRound + 1;
  }

  size_t letters() const { return count * ranks; }
  // Of all rounds' letters, the one for the rank that measures the brick's column.
  size_t LetterOf(BrickKey key) const { return ColumnHash(key.coordinates()) % letters(); }

  size_t ranks;
  size_t count;
};

// The rounds of an object's columns.
template <typename T>
class EuclideanRounds {
 public:
  EuclideanRounds(Exchange& exchange, const RankBricks& bricks, const exec::Context& context,
                  ShellStore& store)
      : exchange_(exchange), bricks_(bricks), context_(context), store_(store) {}

  // Takes the bricks of this rank's layers and of those beside, and lets go of them on its way.
  // Errors: OUT_OF_RANGE where T is too small for the distances of the object.
  absl::Status Run(const LayerOwners& layers, Volume volume) {
    const ColumnRounds columns(exchange_, volume, kBytes);
    std::vector<Bytes> letters = MeasureLayers(layers, columns, volume);
    volume = {};
    for (size_t round = 0; round < columns.count; ++round) {
      BCCSKEL_RETURN_IF_ERROR(AgreeToGoOn(exchange_, context_));
      const auto first = letters.begin() + static_cast<ptrdiff_t>(round * columns.ranks);
      const auto last = first + static_cast<ptrdiff_t>(columns.ranks);
      uint64_t largest = MeasureColumns(
          TradeWithAll(exchange_, {std::make_move_iterator(first), std::make_move_iterator(last)}));
      exchange_.Max({&largest, 1});
      if (sizeof(T) == sizeof(uint16_t) && largest >= kFirstUnsureSquare) {
        return absl::OutOfRangeError("deeper than 16 bits");
      }
    }
    return absl::OkStatus();
  }

 private:
  static constexpr size_t kBeside = kLayersBeside * kLayerPoints;
  static constexpr size_t kSquares = kBrickPoints + kBeside;
  static constexpr size_t kBytes = sizeof(BrickKey) + sizeof(BrickBits) + kSquares * sizeof(T);

  // Packs the squares of this rank's layers for those who measure columns. The memory of what is
  // packed goes back, so that nearly all squares are there only once.
  std::vector<Bytes> MeasureLayers(const LayerOwners& layers, const ColumnRounds& columns,
                                   const Volume& volume) {
    EuclideanParts<T> parts(volume.brick_count());
    MeasureWithinLayers(volume, SideRunsOf(volume, context_), context_, parts);
    const exec::Share own =
        BricksOfLayers(volume, layers.FirstOf(exchange_.rank()), layers.EndOf(exchange_.rank()));
    std::vector<size_t> counts(columns.letters());
    for (size_t n = own.begin; n < own.end; ++n) ++counts[columns.LetterOf(volume.keys()[n])];
    std::vector<Bytes> letters(columns.letters());
    constexpr size_t kAtOnce = 8192;
    for (size_t n = own.begin; n < own.end; ++n) {
      const size_t slot = columns.LetterOf(volume.keys()[n]);
      Bytes& letter = letters[slot];
      if (letter.empty()) letter.reserve(counts[slot] * kBytes);
      PackBrick(volume.keys()[n], volume.bricks()[n], letter);
      Pack(std::span(parts.own).subspan(n * kBrickPoints, kBrickPoints), letter);
      Pack(std::span(parts.beside).subspan(n * kBeside, kBeside), letter);
      if ((n - own.begin) % kAtOnce != 0) continue;
      exec::DropHugePages(parts.own.data(), n * kBrickPoints * sizeof(T));
      exec::DropHugePages(parts.beside.data(), n * kBeside * sizeof(T));
    }
    return letters;
  }

  uint64_t MeasureColumns(std::vector<Bytes> in) {
    std::vector<BrickKey> keys;
    std::vector<BrickBits> bits;
    size_t count = 0;
    for (const Bytes& letter : in) {
      count += letter.size() / kBytes;
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
                              const LayerOwners& layers, const exec::Context& context,
                              ShellStore& store) {
  const auto move = [&] { return MoveToLayers(exchange, layers, bricks.local, bricks.own); };
  Volume volume = move();
  uint64_t is_deep = IsDeep(volume) ? 1 : 0;
  exchange.Max({&is_deep, 1});
  if (AxisScaleOf(volume.placement()) == kIsotropic && is_deep == 0) {
    EuclideanRounds<uint16_t> rounds(exchange, bricks, context, store);
    const absl::Status done = rounds.Run(layers, std::move(volume));
    if (!absl::IsOutOfRange(done)) return done;
    volume = move();
  }
  return EuclideanRounds<float>(exchange, bricks, context, store).Run(layers, std::move(volume));
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

absl::Status MeasureChamfer(Exchange& exchange, const RankBricks& bricks, const LayerOwners& layers,
                            DistanceKind kind, double shell_width, Depths depths,
                            const exec::Context& context, ShellStore& store) {
  const Volume volume = MoveToLayers(exchange, layers, bricks.local, bricks.own);
  RankRelay relay(exchange);
  const HeldLayers held = {layers.FirstOf(exchange.rank()), layers.EndOf(exchange.rank())};
  store.Expect(volume, BricksOfLayers(volume, held.first, held.end));
  const ShellPlaces shells = [&](BrickIndex n) { return store.ShellsOf(n); };
  DepthPlaces deep;
  if (depths == Depths::kWanted)
    deep = [&](BrickIndex n) -> DepthPlanes& { return store.DepthsOf(n); };
  (void)StreamShellsOfLayers(volume, held, kind, shell_width, context, relay, shells, deep);
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
            ? MeasureEuclidean(exchange, bricks, layers, context, store)
            : MeasureChamfer(exchange, bricks, layers, kind, shell_width, depths, context, store));
  }
  // A rank thins for long and measures once, so blocks of squares are not kept for another time.
  exec::ProcessLargeBlocks().ReleaseUnused();
  exec::ProcessLargeBlocks().ReleaseUnused();
  return std::move(store).Finish();
}

}  // namespace bccskel::ranks
