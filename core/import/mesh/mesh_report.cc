#include "core/import/mesh/mesh_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/exec/union_find.h"
#include "core/import/mesh/boundary_loops.h"
#include "core/import/mesh/shell_nesting.h"
#include "core/import/mesh/surface_edges.h"
#include "core/import/mesh/weld.h"
#include "core/lattice/lattice_point.h"

namespace bccskel {
namespace {

using Vertex = TriangleMesh::Vertex;
using Triangle = TriangleMesh::Triangle;

struct Box {
  Vertex lower = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                  std::numeric_limits<double>::infinity()};
  Vertex upper = {-lower[0], -lower[1], -lower[2]};

  void Include(const Vertex& v) {
    for (size_t axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], v[axis]);
      upper[axis] = std::max(upper[axis], v[axis]);
    }
  }
  // Half the longest edge; half, because the whole may overflow.
  double HalfSize() const {
    double half = 0;
    for (size_t axis = 0; axis < 3; ++axis)
      half = std::max(half, upper[axis] / 2 - lower[axis] / 2);
    return half;
  }
};

bool NamesVertexTwice(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

Box BoxOf(const TriangleMesh& mesh) {
  Box box;
  for (const Triangle& triangle : mesh.triangles) {
    for (uint32_t v : triangle) box.Include(mesh.vertices[v]);
  }
  return box;
}

// Moves the box of the triangles to the origin and scales its longest edge to 1.
void ScaleToUnit(TriangleMesh& mesh, Surface& surface) {
  const Box box = BoxOf(mesh);
  if (mesh.triangles.empty()) return;
  surface.lower = box.lower;
  surface.half_size = box.HalfSize();
  const double half = surface.half_size > 0 ? surface.half_size : 1;
  for (Vertex& v : mesh.vertices) {
    for (size_t axis = 0; axis < 3; ++axis) v[axis] = (v[axis] / 2 - box.lower[axis] / 2) / half;
  }
  surface.report.lower = box.lower;
  surface.report.upper = box.upper;
  for (size_t axis = 0; axis < 3; ++axis) {
    surface.upper_unit[axis] = (box.upper[axis] / 2 - box.lower[axis] / 2) / half;
  }
}

// Triangles and sides of one way to read the mesh.
struct Reading {
  TriangleMesh mesh;
  std::vector<TriangleSide> sides;
  EdgeCounts counts;

  SurfaceClosure closure() const {
    if (mesh.triangles.empty() || counts.odd > 0) return SurfaceClosure::kOpen;
    return counts.unbalanced > 0 ? SurfaceClosure::kClosed : SurfaceClosure::kOriented;
  }
};

Reading Read(TriangleMesh mesh) {
  std::erase_if(mesh.triangles, NamesVertexTwice);
  Reading reading;
  reading.sides = SortedSides(mesh.triangles);
  reading.counts = CountEdges(reading.sides);
  reading.mesh = std::move(mesh);
  return reading;
}

// Needs: coordinates in the unit cube, so that small meshes do not look flat.
Reading ReadWithoutFlatTriangles(TriangleMesh mesh) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    const Vertex& a = mesh.vertices[t[0]];
    const Vertex normal = Cross(Minus(mesh.vertices[t[1]], a), Minus(mesh.vertices[t[2]], a));
    return Dot(normal, normal) == 0;
  });
  return Read(std::move(mesh));
}

// The reading that closes the surface best; among equals the one that changes the file least.
Reading ChooseReading(const TriangleMesh& mesh) {
  Reading best = Read(mesh);
  const auto improve = [&best](Reading reading) {
    if (reading.closure() > best.closure()) best = std::move(reading);
  };
  if (best.closure() != SurfaceClosure::kOriented) improve(ReadWithoutFlatTriangles(mesh));
  if (best.closure() == SurfaceClosure::kOriented) return best;
  const TriangleMesh welded = WeldVertices(mesh);
  Reading joined = Read(welded);
  // An open surface is best described by what is left open after welding.
  if (best.closure() == SurfaceClosure::kOpen) {
    best = std::move(joined);
  } else {
    improve(std::move(joined));
  }
  if (best.closure() != SurfaceClosure::kOriented) improve(ReadWithoutFlatTriangles(welded));
  return best;
}

bool IsReverse(const Triangle& a, const Triangle& b) {
  for (size_t n = 0; n < 3; ++n) {
    if (a[0] == b[n] && a[1] == b[(n + 2) % 3] && a[2] == b[(n + 1) % 3]) return true;
  }
  return false;
}

// The place of each triangle's reverse, where every triangle has one: a surface whose facets are
// all there from both sides encloses nothing by any rule. Empty otherwise.
std::vector<uint32_t> ReversesOf(const std::vector<Triangle>& triangles) {
  using Corners = std::array<uint32_t, 4>;  // sorted, and whether the triangle turns as they do
  std::vector<std::pair<Corners, uint32_t>> sorted;
  const auto is_reverse_of_first = [&](const Triangle& t) { return IsReverse(triangles[0], t); };
  if (triangles.size() % 2 != 0) return {};
  if (std::ranges::none_of(triangles, is_reverse_of_first)) return {};  // mostly
  for (const Triangle& t : triangles) {
    const auto first = static_cast<size_t>(std::ranges::min_element(t) - t.begin());
    const uint32_t second = t[(first + 1) % 3], third = t[(first + 2) % 3];
    const Corners corners = {t[first], std::min(second, third), std::max(second, third),
                             second < third ? 0U : 1U};
    sorted.emplace_back(corners, static_cast<uint32_t>(sorted.size()));
  }
  std::ranges::sort(sorted);
  std::vector<uint32_t> reverses(triangles.size());
  const auto is_other = [](const Corners& a, const Corners& b) {
    return a[0] != b[0] || a[1] != b[1] || a[2] != b[2];
  };
  for (size_t begin = 0; begin < sorted.size();) {
    size_t end = begin;
    while (end < sorted.size() && !is_other(sorted[begin].first, sorted[end].first)) ++end;
    for (const size_t half = (end - begin) / 2; begin < end - half; ++begin) {
      if (begin + half == end) return {};
      const auto& [a, first] = sorted[begin];
      const auto& [b, second] = sorted[begin + half];
      if (a[3] == b[3]) return {};
      reverses[first] = second;
      reverses[second] = first;
    }
    begin = end;
  }
  return reverses;
}

// One of each two facets that are each other's reverse, the first in the file. What that leaves may
// be open: both sides together would enclose nothing by any rule.
Reading ReadOneSide(Reading reading, MeshReport& report) {
  const std::vector<uint32_t> reverses = ReversesOf(reading.mesh.triangles);
  if (reverses.empty()) return reading;
  std::vector<Triangle> kept;
  for (uint32_t t = 0; t < reverses.size(); ++t) {
    if (t < reverses[t]) kept.push_back(reading.mesh.triangles[t]);
  }
  const uint64_t count = kept.size();
  Reading one_side = Read({reading.mesh.vertices, std::move(kept)});
  report.two_sided_triangles = count;
  return one_side;
}

// Numbers the components in the order of their first triangles.
std::vector<uint32_t> LabelComponents(const Reading& reading, uint32_t& count) {
  UnionFind<uint32_t> sets(reading.mesh.triangles.size());
  ForEachEdge(reading.sides, [&](std::span<const TriangleSide> edge) {
    for (const TriangleSide& side : edge) sets.Unite(edge[0].triangle, side.triangle);
  });
  std::vector<uint32_t> label(reading.mesh.triangles.size());
  count = 0;
  for (uint32_t t = 0; t < label.size(); ++t) {
    const uint32_t first = sets.Find(t);
    label[t] = first == t ? count++ : label[first];
  }
  return label;
}

// Euler characteristic of each component with vertices that only touch taken apart: a vertex counts
// once for every fan of triangles around it. Nothing where an edge is not in two triangles.
std::vector<std::optional<int64_t>> EulerCharacteristics(const Reading& reading,
                                                         std::span<const uint32_t> component_of,
                                                         uint32_t components) {
  std::vector<std::optional<int64_t>> euler(components, 0);
  const auto add = [&](uint32_t triangle, int64_t value) {
    std::optional<int64_t>& sum = euler[component_of[triangle]];
    if (sum) *sum += value;
  };
  UnionFind<uint32_t> fans(3 * reading.mesh.triangles.size());
  ForEachEdge(reading.sides, [&](std::span<const TriangleSide> edge) {
    add(edge[0].triangle, -1);
    if (edge.size() != 2) {
      euler[component_of[edge[0].triangle]].reset();
      return;
    }
    const auto corner = [](const TriangleSide& s, int c) {
      return 3 * s.triangle + static_cast<uint32_t>(c);
    };
    fans.Unite(corner(edge[0], edge[0].smaller_corner()),
               corner(edge[1], edge[1].smaller_corner()));
    fans.Unite(corner(edge[0], edge[0].larger_corner()), corner(edge[1], edge[1].larger_corner()));
  });
  for (uint32_t t = 0; t < reading.mesh.triangles.size(); ++t) {
    add(t, 1);
    for (uint32_t c = 3 * t; c < 3 * t + 3; ++c) add(t, fans.Find(c) == c ? 1 : 0);
  }
  return euler;
}

// Volume between the triangle and a point; a near one keeps the digits of small components.
double SignedVolume(const Surface& surface, const Triangle& t, const Vertex& apex) {
  const Vertex a = Minus(surface.vertices[t[0]], apex);
  const Vertex b = Minus(surface.vertices[t[1]], apex);
  const Vertex c = Minus(surface.vertices[t[2]], apex);
  return Dot(a, Cross(b, c)) / 6;
}

double AreaOf(std::span<const Vertex> vertices, std::span<const Triangle> triangles) {
  double area = 0;
  for (const auto& [a, b, c] : triangles) {
    const Vertex normal = Cross(Minus(vertices[b], vertices[a]), Minus(vertices[c], vertices[a]));
    area += LengthOf(normal) / 2;
  }
  return area;
}

double HoleShare(const Surface& surface) {
  const double whole = AreaOf(surface.vertices, surface.triangles);
  return whole > 0 ? AreaOf(surface.vertices, CapsOf(surface.boundary_loops)) / whole : 0;
}

Vertex ToWorld(const Surface& surface, const Vertex& unit) {
  Vertex world;
  for (size_t axis = 0; axis < 3; ++axis) {
    world[axis] = surface.lower[axis] + unit[axis] * surface.half_size;
    world[axis] += unit[axis] * surface.half_size;
  }
  return world;
}

// Unit volumes go into the report; WorldVolumes() turns them into world volumes at the end.
void MeasureComponents(Surface& surface) {
  std::vector<SurfaceComponent>& components = surface.report.components;
  std::vector<Box> boxes(components.size());
  std::vector<Vertex> apexes(components.size());
  for (size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& triangle = surface.triangles[t];
    const uint32_t n = surface.component_of[t];
    if (components[n].triangles++ == 0) apexes[n] = surface.vertices[triangle[0]];
    components[n].volume += SignedVolume(surface, triangle, apexes[n]);
    for (uint32_t v : triangle) boxes[n].Include(surface.vertices[v]);
  }
  for (size_t n = 0; n < boxes.size(); ++n) {
    components[n].lower = ToWorld(surface, boxes[n].lower);
    components[n].upper = ToWorld(surface, boxes[n].upper);
    components[n].root = static_cast<uint32_t>(n);
  }
}

void SumVolumes(Surface& surface) {
  for (const SurfaceComponent& component : surface.report.components) {
    surface.unit_volume += component.orientation * std::abs(component.volume);
  }
}

void WorldVolumes(Surface& surface) {
  const double size = 2 * surface.half_size;
  surface.report.volume = 0;
  for (SurfaceComponent& component : surface.report.components) {
    if (component.volume != 0) component.volume = component.volume * size * size * size;
    surface.report.volume += component.volume;
  }
}

uint64_t CountUsedVertices(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (uint32_t v : triangle) used[v] = true;
  }
  return static_cast<uint64_t>(std::ranges::count(used, true));
}

void ReportGenus(const std::vector<std::optional<int64_t>>& euler, MeshReport& report) {
  report.genus = 0;
  for (size_t n = 0; n < euler.size(); ++n) {
    if (euler[n] && *euler[n] % 2 == 0) report.components[n].genus = (2 - *euler[n]) / 2;
    if (!report.components[n].genus) {
      report.genus.reset();
    } else if (report.genus) {
      *report.genus += *report.components[n].genus;
    }
  }
}

void ReportEdges(const Reading& reading, MeshReport& report) {
  report.vertices = CountUsedVertices(reading.mesh);
  report.triangles = reading.mesh.triangles.size();
  report.edges = reading.counts.edges;
  report.boundary_edges = reading.counts.boundary;
  report.non_manifold_edges = reading.counts.non_manifold;
  ForEachEdge(reading.sides, [&](std::span<const TriangleSide> edge) {
    const auto ascending = static_cast<size_t>(
        std::ranges::count_if(edge, [](const TriangleSide& s) { return s.ascending; }));
    const size_t descending = edge.size() - ascending;
    const size_t surplus = ascending > descending ? ascending - descending : descending - ascending;
    report.misoriented_edges += edge.size() > 1 && surplus > edge.size() % 2 ? 1 : 0;
  });
  report.closure = reading.closure();
}

// Walks over the walls of the solid: components with the solid on exactly one side.
template <typename IsSolid>
std::optional<SolidTopology> ReadOffSolid(const MeshReport& report, IsSolid is_solid) {
  if (!report.watertight() || !report.nesting_known || !report.genus) return std::nullopt;
  SolidTopology solid;
  for (const SurfaceComponent& component : report.components) {
    const auto [outside, inside] = is_solid(component);
    if (outside == inside) continue;
    solid.loops += *component.genus;
    (inside ? solid.components : solid.cavities) += 1;
  }
  return solid;
}

}  // namespace

Surface PrepareSurface(const TriangleMesh& mesh) {
  Surface surface;
  TriangleMesh unit = mesh;
  ScaleToUnit(unit, surface);
  Reading reading = ReadOneSide(ChooseReading(unit), surface.report);
  ReportEdges(reading, surface.report);
  surface.report.dropped_triangles =
      mesh.triangles.size() - reading.mesh.triangles.size() - surface.report.two_sided_triangles;
  uint32_t components = 0;
  surface.component_of = LabelComponents(reading, components);
  surface.report.components.resize(components);
  ReportGenus(EulerCharacteristics(reading, surface.component_of, components), surface.report);
  if (surface.report.closure == SurfaceClosure::kOpen) {
    surface.boundary_loops = BoundaryLoops(reading.sides, reading.mesh.vertices.size());
  }
  surface.vertices = std::move(reading.mesh.vertices);
  surface.triangles = std::move(reading.mesh.triangles);
  MeasureComponents(surface);
  surface.report.hole_share = HoleShare(surface);
  if (surface.report.closure != SurfaceClosure::kOpen) FindNesting(surface);
  SumVolumes(surface);
  WorldVolumes(surface);
  return surface;
}

MeshReport AnalyzeMesh(const TriangleMesh& mesh) { return PrepareSurface(mesh).report; }

std::optional<SolidTopology> MeshReport::SolidByParity() const {
  return ReadOffSolid(*this, [](const SurfaceComponent& component) {
    const bool outside = component.depth % 2 == 1;
    return std::pair(outside, !outside);
  });
}

std::optional<SolidTopology> MeshReport::SolidByWinding() const {
  if (closure != SurfaceClosure::kOriented) return std::nullopt;
  return ReadOffSolid(*this, [](const SurfaceComponent& component) {
    const int outside = component.winding_outside;
    return std::pair(outside != 0, outside + component.orientation != 0);
  });
}

}  // namespace bccskel
