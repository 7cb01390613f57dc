#ifndef BCCSKEL_CORE_EXEC_UNINITIALIZED_H_
#define BCCSKEL_CORE_EXEC_UNINITIALIZED_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "core/exec/large_blocks.h"

namespace bccskel::exec {

// For large buffers in which every element is written before it is read: growing a vector does not
// initialize the new elements.
template <typename T>
class UninitializedAllocator : public std::allocator<T> {
 public:
  template <typename U>
  struct rebind {
    using other = UninitializedAllocator<U>;
  };
  T* allocate(size_t count) {
    if (count < kSmallest) return std::allocator<T>::allocate(count);
    if (count > SIZE_MAX / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(ProcessLargeBlocks().Take(count * sizeof(T)));
  }
  void deallocate(T* block, size_t count) {
    if (count < kSmallest) return std::allocator<T>::deallocate(block, count);
    ProcessLargeBlocks().Give(block, count * sizeof(T));
  }
  void construct(T*) noexcept {}
  template <typename... Args>
  void construct(T* at, Args&&... args) {
    std::construct_at(at, std::forward<Args>(args)...);
  }

 private:
  static constexpr size_t kSmallest = LargeBlocks::kSmallest / sizeof(T);
};

template <typename T>
using UninitializedVector = std::vector<T, UninitializedAllocator<T>>;

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_UNINITIALIZED_H_
