#ifndef BCCSKEL_CORE_RANKS_BORDER_PARTNERS_H_
#define BCCSKEL_CORE_RANKS_BORDER_PARTNERS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/ranks/exchange.h"
#include "core/ranks/rank_bricks.h"
#include "core/thinning/sweep_partners.h"

namespace bccskel::ranks {

// Tells ranks with adjacent bricks which points this rank's bricks lose.
class BorderPartners : public SweepPartners {
 public:
  // Needs: both outlive this.
  BorderPartners(Exchange& exchange, const RankBricks& bricks);

  exec::Share own() const override { return bricks_.own; }
  void Tell(const MarkedBrick& lost) override;
  std::span<const MarkedBrick> Hear() override;
  void Sum(std::span<uint64_t> numbers) override { exchange_.Sum(numbers); }

 private:
  struct Listener {
    uint32_t peer = 0;
    uint32_t place = 0;  // index in the list of bricks that the peer is told about
  };

  Exchange& exchange_;
  const RankBricks& bricks_;
  std::vector<int> peers_;
  // The listeners of brick n are listeners_[first_listener_[n]..first_listener_[n + 1]).
  std::vector<uint32_t> first_listener_;
  std::vector<Listener> listeners_;
  std::vector<Bytes> out_;
  std::vector<Bytes> in_;
  std::vector<MarkedBrick> heard_;
};

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_BORDER_PARTNERS_H_
