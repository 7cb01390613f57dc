#ifndef BCCSKEL_CORE_EXEC_UNINITIALIZED_H_
#define BCCSKEL_CORE_EXEC_UNINITIALIZED_H_

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "core/exec/huge_pages.h"

namespace bccskel::exec {

// For large buffers whose every element is written before it is read: growing a vector leaves the
// new elements as they are in memory.
template <typename T>
class UninitializedAllocator : public std::allocator<T> {
 public:
  template <typename U>
  struct rebind {
    using other = UninitializedAllocator<U>;
  };
  T* allocate(size_t count) {
    T* block = std::allocator<T>::allocate(count);
    PreferHugePages(block, count * sizeof(T));
    return block;
  }
  void construct(T*) noexcept {}
  template <typename... Args>
  void construct(T* at, Args&&... args) {
    std::construct_at(at, std::forward<Args>(args)...);
  }
};

template <typename T>
using UninitializedVector = std::vector<T, UninitializedAllocator<T>>;

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_UNINITIALIZED_H_
