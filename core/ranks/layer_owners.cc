#include "core/ranks/layer_owners.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace bccskel::ranks {

void PackBrick(BrickKey key, const BrickBits& bits, Bytes& to) {
  Pack(key, to);
  Pack(bits.words, to);
}
void TakeBrick(Unpacker& from, std::vector<BrickKey>& keys, std::vector<BrickBits>& bits) {
  keys.push_back(from.Take<BrickKey>());
  from.Take(std::span(bits.emplace_back().words));
}

LayerOwners::LayerOwners(Exchange& exchange, const Volume& local, exec::Share own)
    : ranks_(static_cast<size_t>((local.extent().nz + kBrickZ - 1) / kBrickZ)) {
  for (size_t n = own.begin; n < own.end; ++n) {
    ++ranks_[static_cast<size_t>(local.keys()[n].coordinates().bz)];
  }
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

size_t LayerOwners::RankOf(int32_t layer) const {
  const size_t last = ranks_.size() - 1;
  return static_cast<size_t>(ranks_[std::min(static_cast<size_t>(std::max(layer, 0)), last)]);
}

int32_t LayerOwners::FirstOf(int rank) const {
  const auto first = std::ranges::lower_bound(ranks_, static_cast<uint64_t>(rank));
  return static_cast<int32_t>(first - ranks_.begin());
}

exec::Share BricksOfLayers(const Volume& volume, int32_t first, int32_t end) {
  const auto index_of = [&](int32_t layer) {
    const auto at = std::ranges::lower_bound(volume.keys(), layer, {},
                                             [](BrickKey key) { return key.coordinates().bz; });
    return static_cast<size_t>(at - volume.keys().begin());
  };
  return {index_of(first), index_of(end)};
}

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
  std::vector<Bytes> in = TradeWithAll(exchange, std::move(out));
  size_t count = 0;
  for (const Bytes& letter : in) count += letter.size() / (sizeof(BrickKey) + sizeof(BrickBits));
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bits;
  keys.reserve(count);
  bits.reserve(count + 1);  // Volume adds one
  for (Bytes& letter : in) {
    for (Unpacker from(letter); !from.done();) TakeBrick(from, keys, bits);
    letter = {};
  }
  return Volume::FromSortedBricks(local.extent(), local.placement(), std::move(keys),
                                  std::move(bits));
}

}  // namespace bccskel::ranks
