#include "tests/support/reference_thinner.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "tests/support/reference_cliques.h"
#include "tests/support/reference_conditions.h"
#include "tests/support/reference_distance.h"
#include "tests/support/reference_point_set.h"

namespace bccskel::test {
namespace {

class Thinner {
 public:
  Thinner(const Volume& object, const ThinningOptions& options)
      : options_(options), object_(object), keep_(options.keep.begin(), options.keep.end()) {
    const std::vector<uint32_t> counts = ReferenceChamfer(object_);
    for (LatticePoint p : object_.SortedPoints()) {
      const int32_t shell = ReferenceShell(counts[object_.Index(p)], options_.shell_width);
      result_.last_shell = std::max(result_.last_shell, shell);
      shells_.emplace_back(p, shell);
      depth_[p] = ReferenceShell(counts[object_.Index(p)], 0.25);
    }
  }

  ReferenceThinning Run() {
    const int32_t last = options_.last_shell == 0
                             ? result_.last_shell
                             : std::min(options_.last_shell, result_.last_shell);
    for (int32_t shell = 1; shell <= last; ++shell) {
      CollectCandidates(shell);
      uint64_t removed = ThinOneCycle();
      while (shell == last && removed > 0) removed = ThinOneCycle();
    }
    if (options_.cleanup == ThinnessCleanup::kOn) CleanUp();
    result_.thin = object_.SortedPoints();
    for (const auto& [p, pass] : births_) result_.isthmuses.push_back({p, pass});
    return result_;
  }

 private:
  // Condition 5: the points still there whose shell is at most the thinning distance.
  void CollectCandidates(int32_t thinning_distance) {
    candidates_.clear();
    for (const auto& [p, shell] : shells_) {
      if (shell <= thinning_distance && object_.Contains(p) && !keep_.contains(p)) {
        candidates_.push_back(p);
      }
    }
  }

  bool KeepsEndPoints() const {
    return options_.kind == SkeletonKind::kCurve || options_.kind == SkeletonKind::kSurface;
  }

  bool IsStubble(LatticePoint p) const {
    if (!KeepsEndPoints()) return false;
    switch (options_.stubble) {
      case StubblePolicy::kKeepTwo:
        return ReferenceIsStubbleKeepTwo(object_, p);
      case StubblePolicy::kLiteral:
        return ReferenceIsStubble(object_, p);
      case StubblePolicy::kNone:
        return false;
    }
    return false;
  }

  // Marks on the snapshot, then removes; returns how many went.
  template <typename Marks>
  uint64_t RemoveAllThat(Marks marks) {
    std::vector<LatticePoint> marked, rest;
    for (LatticePoint p : candidates_) (marks(p) ? marked : rest).push_back(p);
    for (LatticePoint p : marked) object_.Erase(p);
    candidates_ = std::move(rest);
    return marked.size();
  }

  uint64_t ThinOneCycle() {
    const uint64_t removed =
        options_.method == ThinningMethod::kSymmetric ? SymmetricPass() : DirectionalCycle();
    ++cycle_;
    result_.removed += removed;
    return removed;
  }

  uint64_t DirectionalCycle() {
    const bool reversed =
        options_.method == ThinningMethod::kDirectionalAlternating && cycle_ % 2 == 1;
    uint64_t removed = 0;
    for (int n = 0; n < 8; ++n) {
      const DiagonalDirection d(reversed ? 7 - n : n);
      removed += RemoveAllThat([&](LatticePoint p) {
        return IsStubble(p) || ReferenceIsRemovable(object_.NeighborsOf(p), d);
      });
      ++result_.passes;
    }
    return removed;
  }

  uint64_t SymmetricPass() {
    std::erase_if(candidates_, [&](LatticePoint p) {
      if (!IsIsthmusToKeep(object_.NeighborsOf(p))) return false;
      births_[p] = cycle_ + 1;
      return keep_.insert(p).second;
    });
    std::set<LatticePoint> simple;
    for (LatticePoint p : candidates_) {
      if (MayGo(object_.NeighborsOf(p))) simple.insert(p);
    }
    simple = ReferenceRuleB(object_, std::move(simple), [this](LatticePoint p) {
      return 4 * int64_t{depth_[p]} + (p.x + p.y + p.z + cycle_) % 4;
    });
    ++result_.passes;
    return RemoveAllThat([&](LatticePoint p) { return simple.contains(p) || IsStubble(p); });
  }

  bool IsIsthmusToKeep(NeighborMask mask) const {
    switch (options_.kind) {
      case SkeletonKind::kCurve:
      case SkeletonKind::kKernel:
        return false;
      case SkeletonKind::kSurface:
        return ReferenceIsTwoIsthmus(mask);
      case SkeletonKind::kIsthmusCurve:
        return ReferenceIsOneIsthmus(mask);
    }
    return false;
  }

  // Condition 1, and Condition 2 where end points are kept.
  bool MayGo(NeighborMask mask) const {
    return (!KeepsEndPoints() || ReferenceCondition2(mask)) && ReferenceCondition1(mask);
  }

  void CleanUp() {
    uint64_t removed = 0;
    do {
      removed = 0;
      for (int color = 0; color < 4; ++color) removed += CleanUpColor(color);
      result_.removed_by_cleanup += removed;
    } while (removed > 0);
  }

  uint64_t CleanUpColor(int color) {
    return RemoveAllThat([&](LatticePoint p) {
      const int sum = (p.x + p.y + p.z) % 4;
      if ((sum + 4) % 4 != color) return false;
      return MayGo(object_.NeighborsOf(p));
    });
  }

  const ThinningOptions& options_;
  ReferencePointSet object_;
  std::set<LatticePoint> keep_;
  std::vector<std::pair<LatticePoint, int32_t>> shells_;
  std::map<LatticePoint, int32_t> depth_;  // in quarters of a lattice unit
  std::vector<LatticePoint> candidates_;
  std::map<LatticePoint, int32_t> births_;
  int32_t cycle_ = 0;
  ReferenceThinning result_;
};

}  // namespace

ReferenceThinning ReferenceThinCounted(const Volume& object, const ThinningOptions& options) {
  return Thinner(object, options).Run();
}

std::vector<LatticePoint> ReferenceThin(const Volume& object, const ThinningOptions& options) {
  return ReferenceThinCounted(object, options).thin;
}

}  // namespace bccskel::test
