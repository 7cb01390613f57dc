#ifndef BCCSKEL_CORE_RANKS_RANK_BRICKS_H_
#define BCCSKEL_CORE_RANKS_RANK_BRICKS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/worker_team.h"
#include "core/ranks/exchange.h"
#include "core/ranks/packing.h"
#include "core/volume/volume.h"

namespace bccskel::ranks {

// Which rank owns which bricks: the bricks of the object, in order, are divided into as many runs
// as there are ranks.
class Owners {
 public:
  // `first` is the smallest key of this rank's bricks, if it has any.
  Owners(Exchange& exchange, std::optional<BrickKey> first);

  // The owner of a key, stored or not. Needs: some rank has bricks.
  int OwnerOf(BrickKey key) const;

 private:
  std::vector<uint64_t> firsts_;  // of the ranks that have bricks
  std::vector<int> ranks_;
};

// A rank's bricks of the object and its ghosts, the adjacent bricks of other ranks.
struct RankBricks {
  struct Peer {
    int rank = 0;
    std::vector<BrickIndex> told;   // own bricks that are the peer's ghosts
    std::vector<BrickIndex> heard;  // ghosts that the peer owns, in the order of its `told`
  };

  Volume local;              // own bricks and ghosts
  exec::Share own = {0, 0};  // own bricks within `local`
  std::vector<Peer> peers;   // by rank
  Owners owners;
};

// Moves bricks so that ranks own equal numbers of them, and the bricks of each rank come before
// those of the next. Initially any rank may have any of them.
// Cost:   besides moving the bricks, about 60 sums over all ranks of one number per rank.
// Errors: INVALID_ARGUMENT if two ranks have the same brick, on all ranks.
absl::StatusOr<Volume> ShareEvenly(Exchange& exchange, Volume part);

// Adds ghosts: all bricks of other ranks that share a face, an edge or a corner with one of this
// rank, of either sublattice. Needs: the bricks of each rank come before those of the next.
RankBricks AddGhosts(Exchange& exchange, Volume own);

// Returns the own bricks of all ranks on rank 0; none on other ranks, which send one after the
// other. Needs: as AddGhosts().
Volume GatherBricks(Exchange& exchange, const Volume& local, exec::Share own);

// Sends the value of each own brick to the ranks that have it as a ghost.
// Shapes: `values` has one for each brick of `local`; may be longer.
template <typename T>
void ShareWithGhosts(Exchange& exchange, const RankBricks& bricks, std::span<T> values) {
  std::vector<int> peers;
  std::vector<Bytes> out;
  for (const RankBricks::Peer& peer : bricks.peers) {
    peers.push_back(peer.rank);
    for (Bytes& to = out.emplace_back(); const BrickIndex n : peer.told) Pack(values[n], to);
  }
  std::vector<Bytes> in(peers.size());
  exchange.Trade(peers, out, in);
  for (size_t p = 0; p < peers.size(); ++p) {
    Unpacker from(in[p]);
    for (const BrickIndex n : bricks.peers[p].heard) values[n] = from.Take<T>();
  }
}

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_RANK_BRICKS_H_
