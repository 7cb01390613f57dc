#include "core/ranks/rank_bricks.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/ranks/agreement.h"

namespace bccskel::ranks {
namespace {

struct PackedBrick {
  BrickKey key;
  BrickBits bits;
};

// Calls visit(key) for the position of a brick and all positions that touch it, of both
// sublattices.
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

// Finds for each other rank the own bricks that are at its positions, or beside them.
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

// Finds where the share of each rank begins among these keys, and where the last one ends. The
// first keys of all shares are found by simultaneous binary search, bit by bit, counting the keys
// below.
// Shapes: `keys` increase.
std::vector<size_t> FindStarts(Exchange& exchange, std::span<const BrickKey> keys) {
  const int ranks = exchange.size();
  uint64_t total = keys.size();
  exchange.Sum({&total, 1});
  uint64_t last = keys.empty() ? 0 : keys.back().value();
  exchange.Max({&last, 1});
  const auto below = [&](uint64_t key) {  // the number of keys below
    return static_cast<size_t>(std::ranges::lower_bound(keys, key, {}, &BrickKey::value) -
                               keys.begin());
  };
  // The largest key that has no more than the wanted number below it.
  std::vector<uint64_t> firsts(static_cast<size_t>(ranks));
  for (int bit = static_cast<int>(std::bit_width(last)) - 1; bit >= 0; --bit) {
    std::vector<uint64_t> counts;
    for (const uint64_t first : firsts) counts.push_back(below(first | uint64_t{1} << bit));
    exchange.Sum(counts);
    for (int rank = 0; rank < ranks; ++rank) {
      const auto r = static_cast<size_t>(rank);
      if (counts[r] <= exec::ShareOf(total, rank, ranks).begin) firsts[r] |= uint64_t{1} << bit;
    }
  }
  std::vector<size_t> starts = {0};
  for (size_t rank = 1; rank < firsts.size(); ++rank) starts.push_back(below(firsts[rank]));
  starts.push_back(keys.size());
  return starts;
}

void SortBricks(std::vector<BrickKey>& keys, std::vector<BrickBits>& bits) {
  if (std::ranges::is_sorted(keys)) return;
  std::vector<BrickIndex> order(keys.size());
  std::iota(order.begin(), order.end(), BrickIndex{0});
  std::ranges::sort(order, {}, [&](BrickIndex n) { return keys[n]; });
  std::vector<BrickBits> sorted;
  sorted.reserve(bits.size() + 1);  // Volume adds one
  for (const BrickIndex n : order) sorted.push_back(bits[n]);
  bits = std::move(sorted);
  std::ranges::sort(keys);
}

absl::Status CheckDistinct(std::span<const BrickKey> keys) {
  const auto twice = std::ranges::adjacent_find(keys);
  if (twice == keys.end()) return absl::OkStatus();
  const BrickCoordinates brick = twice->coordinates();
  return absl::InvalidArgumentError(
      absl::StrFormat("brick (%d, %d, %d) is given twice", brick.bx, brick.by, brick.bz));
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

absl::StatusOr<Volume> ShareEvenly(Exchange& exchange, Volume part) {
  const std::vector<size_t> starts = FindStarts(exchange, part.keys());
  std::vector<Bytes> out(starts.size() - 1);
  for (size_t rank = 0; rank < out.size(); ++rank) {
    const size_t first = starts[rank], count = starts[rank + 1] - first;
    out[rank].reserve(count * (sizeof(BrickKey) + sizeof(BrickBits)) + sizeof(uint64_t));
    Pack(uint64_t{count}, out[rank]);
    Pack(part.keys().subspan(first, count), out[rank]);
    Pack(part.bricks().subspan(first, count), out[rank]);
  }
  part = Volume::FromSortedBricks(part.extent(), part.placement(), {}, {});
  std::vector<Bytes> in = TradeWithAll(exchange, std::move(out));
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bits;
  for (Bytes& letter : in) {
    Unpacker from(letter);
    const size_t count = from.Take<uint64_t>(), at = keys.size();
    keys.resize(at + count);
    bits.resize(at + count);
    from.Take(std::span(keys).subspan(at));
    from.Take(std::span(bits).subspan(at));
    letter = {};
  }
  SortBricks(keys, bits);
  BCCSKEL_RETURN_IF_ERROR(AgreeOn(exchange, CheckDistinct(keys)));
  return Volume::FromSortedBricks(part.extent(), part.placement(), std::move(keys),
                                  std::move(bits));
}

RankBricks AddGhosts(Exchange& exchange, Volume own) {
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

  // Positions of a rank may be empty, so it answers which of the offered bricks it takes.
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

  const size_t own_count = own.brick_count();
  const auto low = static_cast<size_t>(std::ranges::count_if(
      ghosts, [&](const PackedBrick& ghost) { return ghost.key < own.keys().front(); }));
  bricks.local = own.empty() ? std::move(own) : Joined(own, ghosts);
  own = {};
  bricks.own = {low, low + own_count};
  size_t next = 0;  // ghosts arrive by rank and so in the order of their keys
  for (size_t rank = 0; rank < answers.size(); ++rank) {
    RankBricks::Peer peer = {static_cast<int>(rank), {}, {}};
    for (size_t n = 0; n < answers[rank].size(); ++n) {
      if (answers[rank][n] != std::byte{0}) {
        peer.told.push_back(offered[rank][n] + static_cast<BrickIndex>(low));
      }
    }
    for (size_t n = 0; n < taken[rank]; ++n, ++next) {
      const size_t at = next < low ? next : next + own_count;
      peer.heard.push_back(static_cast<BrickIndex>(at));
    }
    if (!peer.told.empty() || !peer.heard.empty()) bricks.peers.push_back(std::move(peer));
  }
  return bricks;
}

Volume GatherBricks(Exchange& exchange, const Volume& local, exec::Share own) {
  const auto own_keys = local.keys().subspan(own.begin, own.end - own.begin);
  const auto own_bits = local.bricks().subspan(own.begin, own.end - own.begin);
  const std::vector<uint64_t> counts = ShareNumber(exchange, own_keys.size());
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bits;
  const Bytes nothing;
  Bytes letter;
  if (exchange.rank() == 0) {
    const auto total = std::accumulate(counts.begin(), counts.end(), size_t{0});
    keys.reserve(total);
    bits.reserve(total + 1);  // Volume adds one
    keys.assign(own_keys.begin(), own_keys.end());
    bits.assign(own_bits.begin(), own_bits.end());
    for (int rank = 1; rank < exchange.size(); ++rank) {
      exchange.Trade({&rank, 1}, {&nothing, 1}, {&letter, 1});
      const size_t at = keys.size(), count = counts[static_cast<size_t>(rank)];
      Unpacker from(letter);
      keys.resize(at + count);
      bits.resize(at + count);
      from.Take(std::span(keys).subspan(at));
      from.Take(std::span(bits).subspan(at));
    }
  } else {
    const int lead = 0;
    Bytes out;
    out.reserve(own_keys.size_bytes() + own_bits.size_bytes());
    Pack(own_keys, out);
    Pack(own_bits, out);
    exchange.Trade({&lead, 1}, {&out, 1}, {&letter, 1});
  }
  return Volume::FromSortedBricks(local.extent(), local.placement(), std::move(keys),
                                  std::move(bits));
}

}  // namespace bccskel::ranks
