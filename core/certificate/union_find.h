#ifndef BCCSKEL_CORE_CERTIFICATE_UNION_FIND_H_
#define BCCSKEL_CORE_CERTIFICATE_UNION_FIND_H_

#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

namespace bccskel {

// Disjoint sets of the numbers 0..size-1.
// Threads: all members from any thread. How many calls of Unite() join two sets, and hence how many
//          sets are left, does not depend on the order of the calls.
class UnionFind {
 public:
  explicit UnionFind(size_t size) : parents_(size) {
    for (size_t n = 0; n < size; ++n) parents_[n].store(n, std::memory_order_relaxed);
  }

  size_t size() const { return parents_.size(); }

  // The set's smallest member. Relaxed order is enough: a parent that is read late is still an
  // ancestor, and only a root's parent is ever decided on, by compare and exchange.
  size_t Find(size_t n) {
    for (;;) {
      const size_t parent = Parent(n);
      if (parent == n) return n;
      const size_t grandparent = Parent(parent);
      if (parent != grandparent) parents_[n].store(grandparent, std::memory_order_relaxed);
      n = grandparent;
    }
  }

  // False when n is not in the root's set; true when that takes no search to see.
  bool IsRightBelow(size_t n, size_t root) const { return Parent(n) == root; }

  // True when a and b were in different sets until now.
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
