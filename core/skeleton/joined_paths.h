#ifndef BCCSKEL_CORE_SKELETON_JOINED_PATHS_H_
#define BCCSKEL_CORE_SKELETON_JOINED_PATHS_H_

#include <cstddef>
#include <vector>

#include "core/skeleton/skeleton_graph.h"

namespace bccskel {

using Path = std::vector<SkeletonPoint>;

// Joins two paths, the second from where the first ends. Where the second begins by going back
// along the first, both are cut short.
inline Path Joined(Path first, const Path& second) {
  size_t back = 0;
  while (first.size() > 1 && back + 2 < second.size() &&
         first[first.size() - 2] == second[back + 1]) {
    first.pop_back();
    ++back;
  }
  first.insert(first.end(), second.begin() + static_cast<ptrdiff_t>(back) + 1, second.end());
  return first;
}

inline Path Reversed(const Path& path) { return {path.rbegin(), path.rend()}; }

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_JOINED_PATHS_H_
