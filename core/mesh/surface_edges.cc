#include "core/mesh/surface_edges.h"

#include <algorithm>
#include <tuple>

namespace bccskel {

std::vector<TriangleSide> SortedSides(std::span<const TriangleMesh::Triangle> triangles) {
  std::vector<TriangleSide> sides;
  sides.reserve(3 * triangles.size());
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    for (uint8_t side = 0; side < 3; ++side) {
      const uint64_t from = triangles[t][side], to = triangles[t][(side + 1u) % 3];
      const bool ascending = from < to;
      sides.push_back({ascending ? from << 32 | to : to << 32 | from, t, side, ascending});
    }
  }
  std::ranges::sort(sides, [](const TriangleSide& a, const TriangleSide& b) {
    return std::tie(a.edge, a.triangle, a.side) < std::tie(b.edge, b.triangle, b.side);
  });
  return sides;
}

EdgeCounts CountEdges(std::span<const TriangleSide> sides) {
  EdgeCounts counts;
  ForEachEdge(sides, [&](std::span<const TriangleSide> edge) {
    const auto ascending = static_cast<size_t>(
        std::ranges::count_if(edge, [](const TriangleSide& s) { return s.ascending; }));
    ++counts.edges;
    counts.boundary += edge.size() == 1 ? 1 : 0;
    counts.non_manifold += edge.size() > 2 ? 1 : 0;
    counts.odd += edge.size() % 2;
    counts.unbalanced += 2 * ascending != edge.size() ? 1 : 0;
  });
  return counts;
}

}  // namespace bccskel
