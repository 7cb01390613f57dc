#ifndef BCCSKEL_CORE_THINNING_SYMMETRIC_RULE_H_
#define BCCSKEL_CORE_THINNING_SYMMETRIC_RULE_H_

#include <array>
#include <mutex>
#include <span>
#include <vector>

#include "core/shells/shells.h"
#include "core/thinning/mark_symmetric.h"
#include "core/thinning/pass_rule.h"
#include "core/thinning/thinning.h"
#include "core/thinning/thinning_state.h"

namespace bccskel {

// Whether a kind of skeleton keeps end points and so has stubble.
constexpr EndPoints EndPointsOf(SkeletonKind kind) {
  return kind == SkeletonKind::kCurve || kind == SkeletonKind::kSurface ? EndPoints::kStay
                                                                        : EndPoints::kMayGo;
}

// Does:  one pass per cycle for all sides at once: finds the simple points, then in three steps
//        unmarks some of them so that the others can be removed together (rule B).
// Paper: the non-directional thinning of its outlook.
// Why it is right: see mark_symmetric.h. A step needs the results of the previous step in the
//   bricks around, so workers meet between steps. A brick in no list has no simple candidates: it
//   had none when last visited, and neither it nor an adjacent brick has changed since.
// Cost:  a brick is visited again only after it, or a brick on which it borders, has changed, or if
//        some of its points were unmarked.
class SymmetricRule : public PassRule {
 public:
  // `depth` as from BuildDepths(). It and `state` must outlive the rule.
  SymmetricRule(const BrickDepths& depth, SkeletonKind kind, ThinningState& state);

  int passes_per_cycle() const override { return 1; }
  int steps() const override { return 4; }
  size_t work() const override { return 4; }
  DirtyMask BitsToVisit(const PassStep&) const override { return kDirectionsDirty; }
  void Mark(const PassStep& at, BrickLists& bricks, DirtyMask* dirty, MarkBuffer& marks,
            std::vector<MarkedBrick>& ends) override;
  void Finish(const BrickLists& bricks) override;

  // The points kept as isthmuses, in lattice order. Needs: no pass is running.
  std::vector<IsthmusBirth> Isthmuses() const;

 private:
  struct Births {
    MarkedBrick points;
    int32_t pass = 0;
  };

  void KeepIsthmuses(int32_t pass, const BrickLists& bricks, MarkBuffer& scratch);
  void Keep(int32_t pass, std::span<const MarkedBrick> points);
  void FindSimpleIn(BrickLists& bricks, std::vector<MarkedBrick>& ends);
  RuleBView ViewOf(const PassStep& at, DirtyMask* dirty);

  const BrickDepths& depth_;
  const SkeletonKind kind_;
  ThinningState& state_;
  // The result of each step; padded, and empty between passes.
  std::array<std::vector<BrickBits>, 3> simple_;
  std::vector<uint8_t> larger_cliques_;
  std::mutex births_mutex_;
  std::vector<Births> births_;  // guarded by births_mutex_; in any order
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_SYMMETRIC_RULE_H_
