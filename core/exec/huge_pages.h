#ifndef BCCSKEL_CORE_EXEC_HUGE_PAGES_H_
#define BCCSKEL_CORE_EXEC_HUGE_PAGES_H_

#include <cstddef>
#include <vector>

namespace bccskel::exec {

// Asks for pages of megabytes under a block that nobody has written to yet, where they fit inside.
// Without them a first touch costs a fault per 4 KiB, more than thinning the points there, and
// every brick of a large object's surface a walk through page tables. Only a wish: nothing depends
// on it.
void PreferHugePages(void* block, size_t bytes);

// Gives the memory of huge pages inside a block back to the system; what was in them is lost.
void DropHugePages(void* block, size_t bytes);

// Room for `count` elements, on huge pages where it is large. Needs: an empty vector.
template <typename T, typename Allocator>
void ReserveLarge(size_t count, std::vector<T, Allocator>& into) {
  into.reserve(count);
  PreferHugePages(into.data(), into.capacity() * sizeof(T));
}

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_HUGE_PAGES_H_
