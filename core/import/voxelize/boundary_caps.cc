#include "core/import/voxelize/boundary_caps.h"

#include <algorithm>
#include <span>

#include "core/exec/disjoint_sets.h"
#include "core/import/mesh/surface_edges.h"

namespace bccskel {
namespace {

// An edge as the caps must pass it: against the surplus of the surface.
struct BoundaryEdge {
  uint32_t from = 0;
  uint32_t to = 0;
  uint32_t piece = 0;  // smallest vertex of its connected piece
};

std::vector<BoundaryEdge> FindBoundary(const Surface& surface) {
  std::vector<BoundaryEdge> boundary;
  ForEachEdge(SortedSides(surface.triangles), [&](std::span<const TriangleSide> edge) {
    int64_t surplus = 0;
    for (const TriangleSide& side : edge) surplus += side.ascending ? 1 : -1;
    const uint32_t low = edge[0].smaller_vertex(), high = edge[0].larger_vertex();
    for (; surplus > 0; --surplus) boundary.push_back({high, low, 0});
    for (; surplus < 0; ++surplus) boundary.push_back({low, high, 0});
  });
  return boundary;
}

void LabelPieces(size_t vertices, std::vector<BoundaryEdge>& boundary) {
  DisjointSets pieces(vertices);
  for (const BoundaryEdge& edge : boundary) pieces.Join(edge.from, edge.to);
  for (BoundaryEdge& edge : boundary) edge.piece = pieces.Find(edge.from);
  std::ranges::stable_sort(boundary, {}, &BoundaryEdge::piece);
}

// Each vertex begins as many edges as it ends, so the mean of the starts weighs all alike.
TriangleMesh::Vertex MeanStart(const Surface& surface, std::span<const BoundaryEdge> piece) {
  TriangleMesh::Vertex mean = {};
  for (const BoundaryEdge& edge : piece) {
    for (size_t axis = 0; axis < 3; ++axis) mean[axis] += surface.vertices[edge.from][axis];
  }
  for (double& coordinate : mean) coordinate /= static_cast<double>(piece.size());
  return mean;
}

}  // namespace

BoundaryCaps CapBoundary(const Surface& surface) {
  std::vector<BoundaryEdge> boundary = FindBoundary(surface);
  LabelPieces(surface.vertices.size(), boundary);
  BoundaryCaps result;
  for (size_t begin = 0; begin < boundary.size();) {
    size_t end = begin;
    while (end < boundary.size() && boundary[end].piece == boundary[begin].piece) ++end;
    const auto apex = static_cast<uint32_t>(surface.vertices.size() + result.apexes.size());
    result.apexes.push_back(MeanStart(surface, std::span(boundary).subspan(begin, end - begin)));
    for (size_t n = begin; n < end; ++n) {
      result.triangles.push_back({boundary[n].from, boundary[n].to, apex});
    }
    result.caps.push_back({begin, end});
    begin = end;
  }
  return result;
}

}  // namespace bccskel
