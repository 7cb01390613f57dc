#ifndef BCCSKEL_CORE_EXEC_HUGE_PAGES_H_
#define BCCSKEL_CORE_EXEC_HUGE_PAGES_H_

#include <cstddef>
#include <vector>

namespace bccskel::exec {

// Advises the system to back a block that has not been written yet with huge pages. Without them
// the first touch costs a page fault per 4 KiB, more than thinning the points there, and each brick
// of a large object's surface a page-table walk. A hint: nothing depends on it.
void PreferHugePages(void* block, size_t bytes);

// Reserves `count` elements, on huge pages if they are large. Needs: an empty vector.
template <typename T, typename Allocator>
void ReserveLarge(size_t count, std::vector<T, Allocator>& into) {
  into.reserve(count);
  PreferHugePages(into.data(), into.capacity() * sizeof(T));
}

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_HUGE_PAGES_H_
