#ifndef BCCSKEL_CORE_CERTIFICATE_UNION_FIND_H_
#define BCCSKEL_CORE_CERTIFICATE_UNION_FIND_H_

#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

namespace bccskel {

// Disjoint sets of the numbers 0..size-1.
// Threads: all members may be called from any thread. How many calls of Unite() join two sets, and
//          hence how many sets remain, does not depend on the order of the calls.
class UnionFind {
 public:
  explicit UnionFind(size_t size) : parents_(size) {
    for (size_t n = 0; n < size; ++n) parents_[n].store(n, std::memory_order_relaxed);
  }

  size_t size() const { return parents_.size(); }

  // The set's smallest member. Relaxed order is enough: a stale parent is still an ancestor, and
  // only a root's parent decides anything, by compare and exchange.
  size_t Find(size_t n) {
    for (;;) {
      const size_t parent = Parent(n);
      if (parent == n) return n;
      const size_t grandparent = Parent(parent);
      if (parent != grandparent) parents_[n].store(grandparent, std::memory_order_relaxed);
      n = grandparent;
    }
  }

  // True if n's parent is `root`: a sufficient test for being in the root's set, without a search.
  bool IsRightBelow(size_t n, size_t root) const { return Parent(n) == root; }

  // Joins the sets of a and b. Returns whether they were different.
  bool Unite(size_t a, size_t b) {
    for (;;) {
      a = Find(a);
      b = Find(b);
      if (a == b) return false;
      if (a > b) std::swap(a, b);
      size_t expected = b;
      if (parents_[b].compare_exchange_strong(expected, a, std::memory_order_relaxed)) return true;
    }
  }

 private:
  size_t Parent(size_t n) const { return parents_[n].load(std::memory_order_relaxed); }

  std::vector<std::atomic<size_t>> parents_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_UNION_FIND_H_
