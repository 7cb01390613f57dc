#include "core/import/mesh/weld.h"

#include <algorithm>
#include <numeric>

namespace bccskel {
namespace {

// first[v] is the smallest index of a vertex that equals v.
std::vector<uint32_t> FirstEqualVertex(const std::vector<TriangleMesh::Vertex>& vertices) {
  std::vector<uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), uint32_t{0});
  std::ranges::sort(order, [&](uint32_t a, uint32_t b) {
    return vertices[a] != vertices[b] ? vertices[a] < vertices[b] : a < b;
  });
  std::vector<uint32_t> first(vertices.size());
  for (size_t n = 0; n < order.size(); ++n) {
    const bool equal = n > 0 && vertices[order[n]] == vertices[order[n - 1]];
    first[order[n]] = equal ? first[order[n - 1]] : order[n];
  }
  return first;
}

}  // namespace

TriangleMesh WeldVertices(const TriangleMesh& mesh) {
  std::vector<uint32_t> index = FirstEqualVertex(mesh.vertices);
  TriangleMesh welded;
  for (uint32_t v = 0; v < index.size(); ++v) {
    if (index[v] == v) {
      index[v] = static_cast<uint32_t>(welded.vertices.size());
      welded.vertices.push_back(mesh.vertices[v]);
    } else {
      index[v] = index[index[v]];  // a smaller vertex: already renumbered
    }
  }
  welded.triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    welded.triangles.push_back({index[a], index[b], index[c]});
  }
  return welded;
}

}  // namespace bccskel
