#ifndef BCCSKEL_CORE_THINNING_DIRECTION_RULE_H_
#define BCCSKEL_CORE_THINNING_DIRECTION_RULE_H_

#include <vector>

#include "core/thinning/pass_rule.h"
#include "core/thinning/thinning.h"
#include "core/thinning/thinning_state.h"

namespace bccskel {

// Does:  eight passes per cycle, one along each direction of D8 (Fig. 9).
// Paper: Conditions 1 to 4. The text leaves the order of the directions open; in a fixed order, the
//        first directions always come first and pull the curve to their side.
// Why it is right: see mark_removable.h; the passes may come in any order.
class DirectionRule : public PassRule {
 public:
  // `state` must outlive the rule. With kDirectionalAlternating directions come from 7 to 0 in
  // every second cycle, with kDirectional always from 0 to 7.
  DirectionRule(const ThinningState& state, ThinningMethod method)
      : state_(state), alternates_(method == ThinningMethod::kDirectionalAlternating) {}

  int passes_per_cycle() const override { return 8; }
  int steps() const override { return 1; }
  size_t work() const override { return 1; }
  DirtyMask BitsToVisit(const PassStep& at) const override;
  void Mark(const PassStep& at, BrickLists& bricks, DirtyMask* dirty, MarkBuffer& marks,
            std::vector<MarkedBrick>& ends) override;
  void Finish(const BrickLists&) override {}

 private:
  DiagonalDirection DirectionOf(const PassStep& at) const;

  const ThinningState& state_;
  const bool alternates_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_DIRECTION_RULE_H_
