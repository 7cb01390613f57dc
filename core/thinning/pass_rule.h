#ifndef BCCSKEL_CORE_THINNING_PASS_RULE_H_
#define BCCSKEL_CORE_THINNING_PASS_RULE_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/thinning/mark_removable.h"
#include "core/thinning/work_list.h"

namespace bccskel {

// The bricks in which one worker marks points during a pass. Only grows.
class MarkBuffer {
 public:
  // Returns room for `count` more bricks, some of which Add() then keeps.
  MarkedBrick* Room(size_t count) {
    if (marked_.size() < count_ + count) marked_.resize(count_ + count);
    return marked_.data() + count_;
  }
  void Add(size_t count) { count_ += count; }
  void Clear() { count_ = 0; }
  // Keeps only the bricks for which `stays` returns true.
  template <typename Stays>
  void Filter(Stays stays) {
    size_t kept = 0;
    for (size_t n = 0; n < count_; ++n) {
      if (stays(marked_[n])) marked_[kept++] = marked_[n];
    }
    count_ = kept;
  }
  std::span<const MarkedBrick> marked() const { return std::span(marked_).first(count_); }

 private:
  std::vector<MarkedBrick> marked_;
  size_t count_ = 0;
};

// The position of a sweep: shells are thinned in cycles, cycles consist of passes, and a pass marks
// points in steps before it removes them.
struct PassStep {
  int32_t shell = 0;
  int32_t cycle = 0;  // counted over all shells
  int pass = 0;       // within the cycle
  int step = 0;       // within the pass
};

// How a pass chooses the points to remove. A step of a brick begins when the bricks around it have
// finished the step before, and their points change only after the brick's last step.
// Threads: Mark() and Finish() are called by several workers at once, for different bricks.
class PassRule {
 public:
  virtual ~PassRule() = default;

  virtual int passes_per_cycle() const = 0;
  virtual int steps() const = 0;
  // Work of a pass per brick, for Context::WorkersFor().
  virtual size_t work() const = 0;
  // A pass visits bricks that are dirty in one of these bits.
  virtual DirtyMask BitsToVisit(const PassStep& at) const = 0;

  // Marks points to remove in the listed bricks. May shorten the lists, which the next step of the
  // pass receives, and make listed bricks dirty again. The first step adds the end points of the
  // listed bricks to `ends`, if end points are kept.
  virtual void Mark(const PassStep& at, BrickLists& bricks, DirtyMask* dirty, MarkBuffer& marks,
                    std::vector<MarkedBrick>& ends) = 0;
  // Called after the last step, while workers remove points.
  virtual void Finish(const BrickLists& bricks) = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_PASS_RULE_H_
