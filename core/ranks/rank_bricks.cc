#include "core/ranks/rank_bricks.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace bccskel::ranks {
namespace {

struct PackedBrick {
  BrickKey key;
  BrickBits bits;
};

// Calls visit(key) for the place of a brick and all that touch it, of both sublattices.
template <typename Visit>
void ForEachAround(BrickKey key, Visit visit) {
  const BrickCoordinates at = key.coordinates();
  for (int32_t dz = -1; dz <= 1; ++dz) {
    for (int32_t dy = -1; dy <= 1; ++dy) {
      for (int32_t dx = -1; dx <= 1; ++dx) {
        for (Sublattice sublattice : kSublattices) {
          visit(BrickKey({at.bx + dx, at.by + dy, at.bz + dz, sublattice}));
        }
      }
    }
  }
}

std::optional<BrickKey> FirstOf(const Volume& volume) {
  if (volume.empty()) return std::nullopt;
  return volume.keys().front();
}

// Tells for each other rank which own bricks are at its places, or beside them.
std::vector<std::vector<BrickIndex>> FindTold(const Volume& own, const Owners& owners, int rank,
                                              int ranks) {
  std::vector<std::vector<BrickIndex>> told(static_cast<size_t>(ranks));
  for (BrickIndex n = 0; n < own.brick_count(); ++n) {
    const BrickCoordinates at = own.keys()[n].coordinates();
    const BrickKey low({at.bx - 1, at.by - 1, at.bz - 1, Sublattice::kEven});
    const BrickKey high({at.bx + 1, at.by + 1, at.bz + 1, Sublattice::kOdd});
    if (owners.OwnerOf(low) == rank && owners.OwnerOf(high) == rank) continue;
    ForEachAround(own.keys()[n], [&](BrickKey key) {
      const int owner = owners.OwnerOf(key);
      std::vector<BrickIndex>& list = told[static_cast<size_t>(owner)];
      if (owner != rank && (list.empty() || list.back() != n)) list.push_back(n);
    });
  }
  return told;
}

bool TouchesOneOf(const Volume& own, BrickKey key) {
  bool touches = false;
  ForEachAround(key, [&](BrickKey around) { touches = touches || own.Find(around).has_value(); });
  return touches;
}

Volume Joined(const Volume& own, const std::vector<PackedBrick>& ghosts) {
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bits;
  keys.reserve(own.brick_count() + ghosts.size());
  bits.reserve(own.brick_count() + ghosts.size() + 1);
  const auto add = [&](const PackedBrick& brick) {
    keys.push_back(brick.key);
    bits.push_back(brick.bits);
  };
  size_t n = 0;
  for (; n < ghosts.size() && ghosts[n].key < own.keys().front(); ++n) add(ghosts[n]);
  keys.insert(keys.end(), own.keys().begin(), own.keys().end());
  bits.insert(bits.end(), own.bricks().begin(), own.bricks().end());
  for (; n < ghosts.size(); ++n) add(ghosts[n]);
  return Volume::FromSortedBricks(own.extent(), own.placement(), std::move(keys), std::move(bits));
}

}  // namespace

Owners::Owners(Exchange& exchange, std::optional<BrickKey> first) {
  const uint64_t none = ~uint64_t{0};  // no brick has this key
  const std::vector<uint64_t> firsts =
      ShareNumber(exchange, first.has_value() ? first->value() : none);
  for (size_t rank = 0; rank < firsts.size(); ++rank) {
    if (firsts[rank] == none) continue;
    firsts_.push_back(firsts[rank]);
    ranks_.push_back(static_cast<int>(rank));
  }
}

int Owners::OwnerOf(BrickKey key) const {
  const auto after = std::ranges::upper_bound(firsts_, key.value());
  const auto run = after == firsts_.begin() ? 0 : after - firsts_.begin() - 1;
  return ranks_[static_cast<size_t>(run)];
}

Volume ShareEvenly(Exchange& exchange, const Volume& part) {
  const std::vector<uint64_t> counts = ShareNumber(exchange, part.brick_count());
  const auto total = std::accumulate(counts.begin(), counts.end(), size_t{0});
  const size_t before =
      std::accumulate(counts.begin(), counts.begin() + exchange.rank(), size_t{0});
  std::vector<Bytes> out(counts.size());
  for (int rank = 0; rank < exchange.size(); ++rank) {
    const exec::Share share = exec::ShareOf(total, rank, exchange.size());
    const size_t first = std::clamp(share.begin, before, before + part.brick_count()) - before;
    const size_t last = std::clamp(share.end, before + first, before + part.brick_count()) - before;
    Bytes& to = out[static_cast<size_t>(rank)];
    to.reserve((last - first) * (sizeof(BrickKey) + sizeof(BrickBits)) + sizeof(uint64_t));
    Pack(uint64_t{last - first}, to);
    Pack(part.keys().subspan(first, last - first), to);
    Pack(part.bricks().subspan(first, last - first), to);
  }
  const std::vector<Bytes> in = TradeWithAll(exchange, std::move(out));
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bits;
  for (const Bytes& letter : in) {
    Unpacker from(letter);
    const size_t count = from.Take<uint64_t>(), at = keys.size();
    keys.resize(at + count);
    bits.resize(at + count);
    from.Take(std::span(keys).subspan(at));
    from.Take(std::span(bits).subspan(at));
  }
  return Volume::FromSortedBricks(part.extent(), part.placement(), std::move(keys),
                                  std::move(bits));
}

RankBricks AddGhosts(Exchange& exchange, const Volume& own) {
  RankBricks bricks{{}, {0, 0}, {}, Owners(exchange, FirstOf(own))};
  const std::vector<std::vector<BrickIndex>> offered =
      FindTold(own, bricks.owners, exchange.rank(), exchange.size());
  std::vector<Bytes> out(offered.size());
  for (size_t rank = 0; rank < offered.size(); ++rank) {
    for (const BrickIndex n : offered[rank]) {
      Pack(PackedBrick{own.keys()[n], own.bricks()[n]}, out[rank]);
    }
  }
  std::vector<Bytes> in = TradeWithAll(exchange, std::move(out));

  // Places of a rank need not have bricks: it answers which of the offered ones it takes.
  std::vector<PackedBrick> ghosts;
  std::vector<size_t> taken(in.size());
  std::vector<Bytes> answers(in.size());
  for (size_t rank = 0; rank < in.size(); ++rank) {
    for (const PackedBrick& brick : Unpacker(in[rank]).TakeRest<PackedBrick>()) {
      const bool wanted = TouchesOneOf(own, brick.key);
      Pack(static_cast<uint8_t>(wanted ? 1 : 0), answers[rank]);
      if (!wanted) continue;
      ghosts.push_back(brick);
      ++taken[rank];
    }
    in[rank] = {};
  }
  answers = TradeWithAll(exchange, std::move(answers));

  bricks.local = own.empty() ? own : Joined(own, ghosts);
  const auto low = static_cast<size_t>(std::ranges::count_if(
      ghosts, [&](const PackedBrick& ghost) { return ghost.key < own.keys().front(); }));
  bricks.own = {low, low + own.brick_count()};
  size_t next = 0;  // ghosts come by rank, and so in the order of their keys
  for (size_t rank = 0; rank < answers.size(); ++rank) {
    RankBricks::Peer peer = {static_cast<int>(rank), {}, {}};
    for (size_t n = 0; n < answers[rank].size(); ++n) {
      if (answers[rank][n] != std::byte{0}) {
        peer.told.push_back(offered[rank][n] + static_cast<BrickIndex>(low));
      }
    }
    for (size_t n = 0; n < taken[rank]; ++n, ++next) {
      const size_t at = next < low ? next : next + own.brick_count();
      peer.heard.push_back(static_cast<BrickIndex>(at));
    }
    if (!peer.told.empty() || !peer.heard.empty()) bricks.peers.push_back(std::move(peer));
  }
  return bricks;
}

}  // namespace bccskel::ranks
