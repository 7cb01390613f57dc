#ifndef BCCSKEL_CORE_EXEC_DISJOINT_SETS_H_
#define BCCSKEL_CORE_EXEC_DISJOINT_SETS_H_

#include <cstdint>
#include <numeric>
#include <vector>

namespace bccskel {

// A partition of 0..size-1 into sets that can be joined; each set is identified by its smallest
// member.
class DisjointSets {
 public:
  explicit DisjointSets(size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), uint32_t{0});
  }

  uint32_t Find(uint32_t member) {
    while (parent_[member] != member) {
      parent_[member] = parent_[parent_[member]];
      member = parent_[member];
    }
    return member;
  }

  void Join(uint32_t a, uint32_t b) {
    a = Find(a);
    b = Find(b);
    if (a < b) {
      parent_[b] = a;
    } else {
      parent_[a] = b;
    }
  }

 private:
  std::vector<uint32_t> parent_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_EXEC_DISJOINT_SETS_H_
