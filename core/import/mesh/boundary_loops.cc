#include "core/import/mesh/boundary_loops.h"

#include <algorithm>
#include <limits>

namespace bccskel {
namespace {

struct BoundaryEdge {
  uint32_t from = 0;
  uint32_t to = 0;
};

// Sorted by their first vertex.
std::vector<BoundaryEdge> FindBoundary(std::span<const TriangleSide> sides) {
  std::vector<BoundaryEdge> boundary;
  ForEachEdge(sides, [&](std::span<const TriangleSide> edge) {
    int64_t surplus = 0;
    for (const TriangleSide& side : edge) surplus += side.ascending ? 1 : -1;
    const uint32_t low = edge[0].smaller_vertex(), high = edge[0].larger_vertex();
    for (; surplus > 0; --surplus) boundary.push_back({high, low});
    for (; surplus < 0; ++surplus) boundary.push_back({low, high});
  });
  std::ranges::stable_sort(boundary, {}, &BoundaryEdge::from);
  return boundary;
}

}  // namespace

// As many edges begin at a vertex as end there, so a walk along unused edges stops only where it
// began. Whenever it comes back to one of its vertices, the part since then is a loop.
std::vector<std::vector<uint32_t>> BoundaryLoops(std::span<const TriangleSide> sides,
                                                 size_t vertices) {
  constexpr size_t kNowhere = std::numeric_limits<size_t>::max();
  const std::vector<BoundaryEdge> boundary = FindBoundary(sides);
  std::vector<size_t> next(vertices + 1);  // first unused edge of each vertex
  for (const BoundaryEdge& edge : boundary) ++next[edge.from + 1];
  for (size_t n = 1; n < next.size(); ++n) next[n] += next[n - 1];
  const std::vector<size_t> first = next;
  std::vector<size_t> position(vertices, kNowhere);  // in the walk
  std::vector<std::vector<uint32_t>> loops;
  std::vector<uint32_t> walk;
  for (const BoundaryEdge& start : boundary) {
    uint32_t at = start.from;
    while (next[at] < first[at + 1]) {
      position[at] = walk.size();
      walk.push_back(at);
      at = boundary[next[at]++].to;
      if (position[at] == kNowhere) continue;
      const auto back = walk.begin() + static_cast<std::ptrdiff_t>(position[at]);
      loops.emplace_back(back, walk.end());
      for (uint32_t vertex : loops.back()) position[vertex] = kNowhere;
      walk.erase(back, walk.end());
    }
  }
  return loops;
}

std::vector<TriangleMesh::Triangle> CapsOf(const std::vector<std::vector<uint32_t>>& loops) {
  std::vector<TriangleMesh::Triangle> caps;
  for (const std::vector<uint32_t>& loop : loops) {
    ForEachTriangleOfCap(0, loop.size() - 1, [&](size_t begin, size_t middle, size_t end) {
      caps.push_back({loop[begin], loop[middle], loop[end]});
    });
  }
  return caps;
}

}  // namespace bccskel
