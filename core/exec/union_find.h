#ifndef BCCSKEL_CORE_EXEC_UNION_FIND_H_
#define BCCSKEL_CORE_EXEC_UNION_FIND_H_

#include <atomic>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace bccskel {

// Disjoint sets of the numbers 0..size-1.
// Threads: all members but Reset() and Add() may be called from any thread. How many calls of
//          Unite() join two sets, and hence how many sets remain, does not depend on the order of
//          the calls.
template <typename Number>
class UnionFind {
 public:
  explicit UnionFind(size_t size) { Reset(size); }

  // Each number is a set of its own again.
  void Reset(size_t size) {
    parents_.resize(size);
    std::iota(parents_.begin(), parents_.end(), Number{0});
  }

  size_t size() const { return parents_.size(); }

  // A further number, a set of its own.
  Number Add() {
    parents_.push_back(static_cast<Number>(parents_.size()));
    return parents_.back();
  }

  // The set's smallest member. Relaxed order is enough: a stale parent is still an ancestor, and
  // only a root's parent decides anything, by compare and exchange.
  Number Find(Number n) {
    for (;;) {
      const Number parent = Parent(n);
      if (parent == n) return n;
      const Number grandparent = Parent(parent);
      if (parent != grandparent) AtomicParent(n).store(grandparent, std::memory_order_relaxed);
      n = grandparent;
    }
  }

  // True if n's parent is `root`: a sufficient test for being in the root's set, without a search.
  bool IsRightBelow(Number n, Number root) { return Parent(n) == root; }

  // Joins the sets of a and b. Returns whether they were different.
  bool Unite(Number a, Number b) {
    for (;;) {
      a = Find(a);
      b = Find(b);
      if (a == b) return false;
      if (a > b) std::swap(a, b);
      Number expected = b;
      if (AtomicParent(b).compare_exchange_strong(expected, a, std::memory_order_relaxed)) {
        return true;
      }
    }
  }

 private:
  std::atomic_ref<Number> AtomicParent(Number n) { return std::atomic_ref(parents_[n]); }
  Number Parent(Number n) { return AtomicParent(n).load(std::memory_order_relaxed); }

  std::vector<Number> parents_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_EXEC_UNION_FIND_H_
