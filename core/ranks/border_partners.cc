#include "core/ranks/border_partners.h"

#include <numeric>

#include "core/ranks/packing.h"

namespace bccskel::ranks {

BorderPartners::BorderPartners(Exchange& exchange, const RankBricks& bricks)
    : exchange_(exchange),
      bricks_(bricks),
      first_listener_(bricks.local.brick_count() + 1),
      out_(bricks.peers.size()),
      in_(bricks.peers.size()) {
  for (const RankBricks::Peer& peer : bricks.peers) {
    peers_.push_back(peer.rank);
    for (const BrickIndex n : peer.told) ++first_listener_[n + 1];
  }
  std::partial_sum(first_listener_.begin(), first_listener_.end(), first_listener_.begin());
  listeners_.resize(first_listener_.back());
  std::vector<uint32_t> next = first_listener_;
  for (uint32_t p = 0; p < bricks.peers.size(); ++p) {
    const std::vector<BrickIndex>& told = bricks.peers[p].told;
    for (uint32_t place = 0; place < told.size(); ++place) {
      listeners_[next[told[place]]++] = {p, place};
    }
  }
}

void BorderPartners::Tell(const MarkedBrick& lost) {
  for (uint32_t n = first_listener_[lost.brick]; n < first_listener_[lost.brick + 1]; ++n) {
    Bytes& to = out_[listeners_[n].peer];
    Pack(listeners_[n].place, to);
    Pack(lost.marks.words, to);
  }
}

std::span<const MarkedBrick> BorderPartners::Hear() {
  exchange_.Trade(peers_, out_, in_);
  heard_.clear();
  for (size_t p = 0; p < in_.size(); ++p) {
    out_[p].clear();
    for (Unpacker from(in_[p]); !from.done();) {
      MarkedBrick& mark = heard_.emplace_back();
      mark.brick = bricks_.peers[p].heard[from.Take<uint32_t>()];
      from.Take(std::span(mark.marks.words));
    }
  }
  return heard_;
}

}  // namespace bccskel::ranks
