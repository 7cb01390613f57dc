#include "core/ranks/rank_shells.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "core/distance/chamfer_weights.h"
#include "core/distance/euclidean_parts.h"
#include "core/exec/status_macros.h"
#include "core/ranks/agreement.h"
#include "core/ranks/packing.h"

namespace bccskel::ranks {
namespace {

// Squares of a round of columns that a rank gets.
constexpr size_t kBytesPerRound = size_t{32} << 20;

void PackBrick(BrickKey key, const BrickBits& bits, Bytes& to) {
  Pack(key, to);
  Pack(bits.words, to);
}
void TakeBrick(Unpacker& from, std::vector<BrickKey>& keys, std::vector<BrickBits>& bits) {
  keys.push_back(from.Take<BrickKey>());
  from.Take(std::span(bits.emplace_back().words));
}

// Which rank measures which layer of bricks: runs of layers with about equally many bricks.
class LayerOwners {
 public:
  LayerOwners(Exchange& exchange, const Volume& own)
      : ranks_(static_cast<size_t>((own.extent().nz + kBrickZ - 1) / kBrickZ)) {
    for (const BrickKey key : own.keys()) ++ranks_[static_cast<size_t>(key.coordinates().bz)];
    exchange.Sum(ranks_);
    const uint64_t total = std::accumulate(ranks_.begin(), ranks_.end(), uint64_t{0});
    const auto size = static_cast<uint64_t>(exchange.size());
    uint64_t before = 0;
    for (uint64_t& layer : ranks_) {
      const uint64_t bricks = layer;
      layer = total == 0 ? 0 : std::min((before + bricks / 2) * size / total, size - 1);
      before += bricks;
    }
  }

  // Of the nearest layer where there is none.
  size_t RankOf(int32_t layer) const {
    return static_cast<size_t>(
        ranks_[std::min(static_cast<size_t>(std::max(layer, 0)), ranks_.size() - 1)]);
  }

 private:
  std::vector<uint64_t> ranks_;
};

// The layers of this rank and those below and above.
Volume MoveToLayers(Exchange& exchange, const LayerOwners& layers, const Volume& local,
                    exec::Share own) {
  std::vector<Bytes> out(static_cast<size_t>(exchange.size()));
  for (size_t n = own.begin; n < own.end; ++n) {
    const int32_t bz = local.keys()[n].coordinates().bz;
    const size_t low = layers.RankOf(bz - 1), middle = layers.RankOf(bz),
                 high = layers.RankOf(bz + 1);
    PackBrick(local.keys()[n], local.bricks()[n], out[low]);
    if (middle != low) PackBrick(local.keys()[n], local.bricks()[n], out[middle]);
    if (high != middle) PackBrick(local.keys()[n], local.bricks()[n], out[high]);
  }
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bits;
  for (const Bytes& letter : TradeWithAll(exchange, std::move(out))) {
    for (Unpacker from(letter); !from.done();) TakeBrick(from, keys, bits);
  }
  return Volume::FromSortedBricks(local.extent(), local.placement(), std::move(keys),
                                  std::move(bits));
}

uint64_t ColumnHash(const BrickCoordinates& at) {
  uint64_t hash = static_cast<uint64_t>(at.by) << 32 | static_cast<uint64_t>(at.bx);
  hash = (hash ^ hash >> 31) * 0x9e3779b97f4a7c15;
  hash = (hash ^ hash >> 29) * 0xbf58476d1ce4e5b9;
  return hash ^ hash >> 32;
}

// Planes and ranges of all local bricks, as they come back from the columns.
struct PlaneStore {
  explicit PlaneStore(size_t bricks) : planes(bricks + 1), ranges(bricks) { planes.back() = {}; }
  Shells Finish(int32_t last) && {
    Shells shells(std::move(planes), std::move(ranges));
    shells.SetLast(last);
    return shells;
  }

  exec::UninitializedVector<ShellPlanes> planes;
  std::vector<Shells::Range> ranges;
};

struct SlicedBrick {
  ShellPlanes planes;
  Shells::Range range;
};

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

template <typename T>
class ShellMeasuring {
 public:
  ShellMeasuring(Exchange& exchange, const RankBricks& bricks, double shell_width, Depths depths,
                 const exec::Context& context)
      : exchange_(exchange),
        bricks_(bricks),
        shell_width_(shell_width),
        depths_(depths),
        context_(context),
        shells_(bricks.local.brick_count()),
        deep_(depths == Depths::kWanted ? bricks.local.brick_count() : 0) {}

  // Errors: OUT_OF_RANGE where T is too small for the distances of the object.
  absl::StatusOr<RankShells> Run() && {
    const LayerOwners layers(exchange_, OwnOnly());
    const Volume volume = MoveToLayers(exchange_, layers, bricks_.local, bricks_.own);
    EuclideanParts<T> parts(volume.brick_count());
    MeasureWithinLayers(volume, context_, parts);
    const ColumnRounds columns(exchange_, layers, volume, kSquares * sizeof(T));
    for (size_t round = 0; round < columns.rounds(); ++round) {
      BCCSKEL_RETURN_IF_ERROR(AgreeToGoOn(exchange_, context_));
      const uint64_t largest = Measure(columns, round, volume, parts);
      if (sizeof(T) == sizeof(uint16_t) && largest >= kFirstUnsureSquare) {
        return absl::OutOfRangeError("deeper than 16 bits");
      }
    }
    return Finish();
  }

 private:
  static constexpr size_t kSquares = kBrickPoints + kLayersBeside * kLayerPoints;

  // Layers are counted by owners, so ghosts do not count.
  Volume OwnOnly() const {
    const auto [begin, end] = bricks_.own;
    const auto keys = bricks_.local.keys().subspan(begin, end - begin);
    const auto bits = bricks_.local.bricks().subspan(begin, end - begin);
    return Volume::FromSortedBricks(bricks_.local.extent(), bricks_.local.placement(),
                                    {keys.begin(), keys.end()}, {bits.begin(), bits.end()});
  }

  // One round; returns the largest square so far of all ranks.
  uint64_t Measure(const ColumnRounds& columns, size_t round, const Volume& volume,
                   const EuclideanParts<T>& parts) {
    std::vector<Bytes> out(static_cast<size_t>(exchange_.size()));
    for (size_t rank = 0; rank < out.size(); ++rank) {
      for (const BrickIndex n : columns.BricksFor(round, rank)) {
        PackBrick(volume.keys()[n], volume.bricks()[n], out[rank]);
        Pack(std::span(parts.own).subspan(size_t{n} * kBrickPoints, kBrickPoints), out[rank]);
        constexpr size_t kBeside = kLayersBeside * kLayerPoints;
        Pack(std::span(parts.beside).subspan(size_t{n} * kBeside, kBeside), out[rank]);
      }
    }
    uint64_t largest = 0;
    std::vector<Bytes> back = MeasureColumns(TradeWithAll(exchange_, std::move(out)), largest);
    for (const Bytes& letter : TradeWithAll(exchange_, std::move(back))) {
      for (Unpacker from(letter); !from.done();) Keep(from);
    }
    exchange_.Max({&largest, 1});
    return largest;
  }

  // Takes whole columns and returns their shells, by owner.
  std::vector<Bytes> MeasureColumns(const std::vector<Bytes>& in, uint64_t& largest) const {
    std::vector<BrickKey> keys;
    std::vector<BrickBits> bits;
    size_t count = 0;
    for (const Bytes& letter : in) {
      count += letter.size() / (sizeof(BrickKey) + sizeof(BrickBits) + kSquares * sizeof(T));
    }
    EuclideanParts<T> parts(count);
    for (const Bytes& letter : in) {
      for (Unpacker from(letter); !from.done();) {
        const size_t n = keys.size();
        TakeBrick(from, keys, bits);
        from.Take(std::span(parts.own).subspan(n * kBrickPoints, kBrickPoints));
        constexpr size_t kBeside = kLayersBeside * kLayerPoints;
        from.Take(std::span(parts.beside).subspan(n * kBeside, kBeside));
      }
    }
    const Volume columns = Volume::FromSortedBricks(
        bricks_.local.extent(), bricks_.local.placement(), std::move(keys), std::move(bits));
    MeasureAcrossLayers(columns, context_, parts);
    const DistanceField field = EuclideanFieldOf(std::move(parts));
    largest = field.largest();
    return Slice(columns, field);
  }

  std::vector<Bytes> Slice(const Volume& columns, const DistanceField& field) const {
    const Shells shells = BuildShells(columns, field, shell_width_, context_);
    std::optional<Shells> deep;
    if (depths_ == Depths::kWanted) deep = BuildDepths(columns, field, context_);
    std::vector<Bytes> back(static_cast<size_t>(exchange_.size()));
    for (BrickIndex n = 0; n < columns.brick_count(); ++n) {
      const BrickKey key = columns.keys()[n];
      Bytes& to = back[static_cast<size_t>(bricks_.owners.OwnerOf(key))];
      Pack(key, to);
      Pack(shells.planes()[n], to);
      Pack(shells.RangeOf(n), to);
      if (deep.has_value()) Pack(deep->planes()[n], to);
    }
    return back;
  }

  void Keep(Unpacker& from) {
    const BrickIndex n = *bricks_.local.Find(from.Take<BrickKey>());
    shells_.planes[n] = from.Take<ShellPlanes>();
    shells_.ranges[n] = from.Take<Shells::Range>();
    if (depths_ == Depths::kWanted) deep_.planes[n] = from.Take<ShellPlanes>();
  }

  RankShells Finish() {
    ShareWithGhosts(exchange_, bricks_, std::span(shells_.planes));
    ShareWithGhosts(exchange_, bricks_, std::span(shells_.ranges));
    if (depths_ == Depths::kWanted) ShareWithGhosts(exchange_, bricks_, std::span(deep_.planes));
    uint64_t last = 0;
    for (const Shells::Range& range : shells_.ranges) {
      last = std::max(last, static_cast<uint64_t>(range.last));
    }
    exchange_.Max({&last, 1});
    return {std::move(shells_).Finish(static_cast<int32_t>(last)), std::move(deep_).Finish(0)};
  }

  Exchange& exchange_;
  const RankBricks& bricks_;
  const double shell_width_;
  const Depths depths_;
  const exec::Context& context_;
  PlaneStore shells_;
  PlaneStore deep_;  // its ranges are not used
};

}  // namespace

absl::StatusOr<RankShells> MeasureShells(Exchange& exchange, const RankBricks& bricks,
                                         double shell_width, Depths depths,
                                         const exec::Context& context) {
  uint64_t is_deep = IsDeep(bricks.local) ? 1 : 0;
  exchange.Max({&is_deep, 1});
  if (AxisScaleOf(bricks.local.placement()) == kIsotropic && is_deep == 0) {
    absl::StatusOr<RankShells> shells =
        ShellMeasuring<uint16_t>(exchange, bricks, shell_width, depths, context).Run();
    if (!absl::IsOutOfRange(shells.status())) return shells;
  }
  return ShellMeasuring<float>(exchange, bricks, shell_width, depths, context).Run();
}

}  // namespace bccskel::ranks
