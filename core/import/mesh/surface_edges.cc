#include "core/import/mesh/surface_edges.h"

#include <algorithm>
#include <tuple>

namespace bccskel {

namespace {

TriangleSide SideOf(std::span<const TriangleMesh::Triangle> triangles, uint32_t t, uint8_t side) {
  const uint64_t from = triangles[t][side], to = triangles[t][(side + 1u) % 3];
  const bool ascending = from < to;
  return {ascending ? from << 32 | to : to << 32 | from, t, side, ascending};
}

template <typename Visit>
void ForEachSide(std::span<const TriangleMesh::Triangle> triangles, Visit visit) {
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    for (uint8_t side = 0; side < 3; ++side) visit(SideOf(triangles, t, side));
  }
}

size_t VerticesNamed(std::span<const TriangleMesh::Triangle> triangles) {
  uint32_t largest = 0;
  for (const auto& triangle : triangles) largest = std::max(largest, std::ranges::max(triangle));
  return triangles.empty() ? 0 : size_t{largest} + 1;
}

}  // namespace

// First by counting, into one bucket for each smaller vertex: few sides share one.
std::vector<TriangleSide> SortedSides(std::span<const TriangleMesh::Triangle> triangles) {
  std::vector<size_t> end(VerticesNamed(triangles) + 1);  // of each bucket once it is filled
  ForEachSide(triangles, [&](const TriangleSide& s) { ++end[s.smaller_vertex() + 1]; });
  for (size_t v = 1; v < end.size(); ++v) end[v] += end[v - 1];
  std::vector<TriangleSide> sides(3 * triangles.size());
  ForEachSide(triangles, [&](const TriangleSide& s) { sides[end[s.smaller_vertex()]++] = s; });
  for (size_t v = 0, begin = 0; v + 1 < end.size(); begin = end[v++]) {
    std::ranges::sort(std::span(sides).subspan(begin, end[v] - begin), {},
                      [](const auto& s) { return std::tie(s.edge, s.triangle, s.side); });
  }
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
