#include "core/import/mesh/shell_nesting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/import/mesh/ray_crossing.h"

namespace bccskel {
namespace {

constexpr uint64_t kMaxComparisons = uint64_t{1} << 30;

// A vertex of a component; the ray from minus infinity ends there.
struct Query {
  GridPoint point;
  uint32_t component = 0;
};

// How many times the ray of a query crosses each other component.
using CrossingCounts = std::map<uint32_t, uint32_t>;

GridPoint Snap(const TriangleMesh::Vertex& unit) {
  constexpr double kScale = static_cast<double>(int64_t{1} << (kGridBits - 1));
  return {std::llround(unit[0] * kScale), std::llround(unit[1] * kScale),
          std::llround(unit[2] * kScale)};
}

// The lowest and the highest vertex of each component along each axis, sorted by height.
std::vector<Query> PlaceQueries(const Surface& surface) {
  constexpr uint32_t kNone = UINT32_MAX;
  std::vector<std::array<uint32_t, 6>> extremes(surface.report.components.size());
  for (auto& of_component : extremes) of_component.fill(kNone);
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const uint32_t v : surface.triangles[t]) {
      for (size_t n = 0; n < 6; ++n) {
        uint32_t& extreme = extremes[surface.component_of[t]][n];
        const double sign = n % 2 == 0 ? 1 : -1;
        const auto place = [&](uint32_t vertex) { return sign * surface.vertices[vertex][n / 2]; };
        if (extreme == kNone || place(v) < place(extreme)) extreme = v;
      }
    }
  }
  std::vector<Query> queries;
  for (uint32_t component = 0; component < extremes.size(); ++component) {
    std::array<uint32_t, 6>& vertices = extremes[component];
    std::ranges::sort(vertices);
    const auto end = std::unique(vertices.begin(), vertices.end());
    for (auto v = vertices.begin(); v != end; ++v) {
      queries.push_back({Snap(surface.vertices[*v]), component});
    }
  }
  std::ranges::stable_sort(queries, {}, [](const Query& q) { return q.point.z; });
  return queries;
}

std::span<const Query> QueriesInRows(std::span<const Query> queries, GridRange rows) {
  const auto z = [](const Query& q) { return q.point.z; };
  const auto begin = std::ranges::lower_bound(queries, rows.begin, {}, z);
  const auto end = std::ranges::lower_bound(queries, rows.end, {}, z);
  return {begin, end};
}

bool Crosses(const RayTriangle& triangle, const GridPoint& p) {
  return triangle.Columns().Contains(p.y) && triangle.CrossedColumns(p.z).Contains(p.y) &&
         p.x >= triangle.FirstBehind(p.y, p.z);
}

RayTriangle SnapTriangle(const Surface& surface, size_t t) {
  const auto& [a, b, c] = surface.triangles[t];
  return RayTriangle(Snap(surface.vertices[a]), Snap(surface.vertices[b]),
                     Snap(surface.vertices[c]));
}

uint64_t CountComparisons(const Surface& surface, std::span<const Query> queries) {
  uint64_t comparisons = 0;
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    comparisons += QueriesInRows(queries, SnapTriangle(surface, t).Rows()).size();
  }
  return comparisons;
}

// For each query.
std::vector<CrossingCounts> CastRays(const Surface& surface, std::span<const Query> queries) {
  std::vector<CrossingCounts> counts(queries.size());
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    const RayTriangle triangle = SnapTriangle(surface, t);
    if (triangle.parallel()) continue;
    for (const Query& query : QueriesInRows(queries, triangle.Rows())) {
      if (query.component != surface.component_of[t] && Crosses(triangle, query.point)) {
        ++counts[static_cast<size_t>(&query - queries.data())][surface.component_of[t]];
      }
    }
  }
  return counts;
}

bool BoxEncloses(const SurfaceComponent& outer, const SurfaceComponent& inner) {
  for (size_t axis = 0; axis < 3; ++axis) {
    if (outer.lower[axis] > inner.lower[axis] || outer.upper[axis] < inner.upper[axis])
      return false;
  }
  return true;
}

// The components that enclose each component.
std::vector<std::vector<uint32_t>> FindEnclosing(const MeshReport& report,
                                                 std::span<const Query> queries,
                                                 const std::vector<CrossingCounts>& counts) {
  const size_t count = report.components.size();
  std::vector<uint32_t> asked(count);
  std::vector<std::map<uint32_t, uint32_t>> insides(count);  // of how many queries
  for (size_t n = 0; n < queries.size(); ++n) {
    ++asked[queries[n].component];
    for (const auto& [outer, crossings] : counts[n]) {
      if (crossings % 2 == 1) ++insides[queries[n].component][outer];
    }
  }
  std::vector<std::vector<uint32_t>> enclosing(count);
  for (size_t inner = 0; inner < count; ++inner) {
    for (const auto& [outer, inside] : insides[inner]) {
      if (inside < asked[inner]) continue;
      if (BoxEncloses(report.components[outer], report.components[inner])) {
        enclosing[inner].push_back(outer);
      }
    }
  }
  return enclosing;
}

int Sense(const SurfaceComponent& component) { return component.volume < 0 ? -1 : 1; }

}  // namespace

void FindNesting(Surface& surface) {
  surface.report.nesting_known = surface.report.components.size() == 1;
  if (surface.report.nesting_known) return;  // as it was made: outermost, its own root
  const std::vector<Query> queries = PlaceQueries(surface);
  if (CountComparisons(surface, queries) > kMaxComparisons) return;
  std::vector<SurfaceComponent>& components = surface.report.components;
  const auto enclosing = FindEnclosing(surface.report, queries, CastRays(surface, queries));
  for (size_t n = 0; n < components.size(); ++n) {
    components[n].depth = static_cast<int32_t>(enclosing[n].size());
  }
  for (size_t n = 0; n < components.size(); ++n) {
    for (uint32_t outer : enclosing[n]) {
      if (components[outer].depth == 0) components[n].root = outer;
    }
    components[n].orientation = Sense(components[n]) * Sense(components[components[n].root]);
  }
  for (size_t n = 0; n < components.size(); ++n) {
    for (uint32_t outer : enclosing[n]) {
      components[n].winding_outside += components[outer].orientation;
    }
  }
  surface.report.nesting_known = true;
}

}  // namespace bccskel
