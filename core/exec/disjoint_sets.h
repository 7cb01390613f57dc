#ifndef BCCSKEL_CORE_EXEC_DISJOINT_SETS_H_
#define BCCSKEL_CORE_EXEC_DISJOINT_SETS_H_

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace bccskel {

// A partition of 0..size-1 into sets that can be joined; each set is identified by its smallest
// member.
class DisjointSets {
 public:
  explicit DisjointSets(size_t size) { Reset(size); }

  // Each number is a set of its own again.
  void Reset(size_t size) {
    parent_.resize(size);
    std::iota(parent_.begin(), parent_.end(), uint32_t{0});
  }

  size_t size() const { return parent_.size(); }

  // A further number, a set of its own.
  uint32_t Add() {
    const auto member = static_cast<uint32_t>(parent_.size());
    parent_.push_back(member);
    return member;
  }

  uint32_t Find(uint32_t member) {
    while (parent_[member] != member) {
      parent_[member] = parent_[parent_[member]];
      member = parent_[member];
    }
    return member;
  }

  // Returns whether the sets of a and b were different.
  bool Join(uint32_t a, uint32_t b) {
    a = Find(a);
    b = Find(b);
    if (a > b) std::swap(a, b);
    parent_[b] = a;
    return a != b;
  }

 private:
  std::vector<uint32_t> parent_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_EXEC_DISJOINT_SETS_H_
