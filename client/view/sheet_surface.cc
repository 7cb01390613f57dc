#include "client/view/sheet_surface.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "client/view/result_balls.h"
#include "core/exec/union_find.h"
#include "core/lattice/directions.h"

namespace bccskel::view {
namespace {

// Smaller connected groups of triangles are thick spots of a curve.
constexpr size_t kLeastTriangles = 40;
constexpr int kSmoothingSteps = 3;

struct Spot {
  LatticePoint point;
  double radius;
  uint32_t label = 0;
};

// nullopt for positions beyond any lattice, as from a damaged placement.
std::optional<LatticePoint> NearestPoint(const std::array<double, 3>& place) {
  constexpr double kFarthest = 2.0 * kMaxExtentCells;
  const auto is_there = [](double v) { return std::abs(v) <= kFarthest; };
  if (!std::ranges::all_of(place, is_there)) return std::nullopt;
  const auto rounded = [](double v) { return static_cast<int32_t>(std::lround(v)); };
  return LatticePoint{rounded(place[0]), rounded(place[1]), rounded(place[2])};
}

// In the order of BallsOf(). Needs: labels.
std::vector<uint32_t> LabelsOfBalls(const ResultDocument& result) {
  std::vector<uint32_t> labels = result.labels->of_nodes;
  for (const ResultDocument::Edge& edge : result.edges) {
    labels.insert(labels.end(), edge.point_count, result.labels->of_nodes[edge.source]);
  }
  labels.insert(labels.end(), result.labels->of_sheets.begin(), result.labels->of_sheets.end());
  return labels;
}

// All points of the skeleton, each once, in lattice order.
std::vector<Spot> SpotsOf(const ResultDocument& result, const Placement& placement) {
  const std::vector<OpenBall> balls = BallsOf(result, placement);
  const std::vector<uint32_t> labels =
      result.labels.has_value() ? LabelsOfBalls(result) : std::vector<uint32_t>(balls.size());
  std::vector<Spot> spots;
  for (size_t n = 0; n < balls.size(); ++n) {
    const std::optional<LatticePoint> p = NearestPoint(balls[n].center);
    if (p.has_value()) spots.push_back({*p, balls[n].radius, labels[n]});
  }
  std::ranges::sort(spots, {}, &Spot::point);
  const auto same = [](const Spot& a, const Spot& b) { return a.point == b.point; };
  spots.erase(std::unique(spots.begin(), spots.end(), same), spots.end());
  return spots;
}

std::optional<uint32_t> Find(const std::vector<Spot>& spots, LatticePoint p) {
  const auto found = std::ranges::lower_bound(spots, p, {}, &Spot::point);
  if (found == spots.end() || found->point != p) return std::nullopt;
  return static_cast<uint32_t>(found - spots.begin());
}

// Three mutually adjacent points each.
std::vector<SurfaceTriangle> TrianglesOf(const std::vector<Spot>& spots) {
  std::vector<SurfaceTriangle> triangles;
  std::vector<uint32_t> later;  // neighbors of a spot that come after it
  for (uint32_t n = 0; n < spots.size(); ++n) {
    later.clear();
    for (const LatticePoint& step : kDirections14) {
      const std::optional<uint32_t> at = Find(spots, spots[n].point + step);
      if (at.has_value() && *at > n && spots[*at].label == spots[n].label) later.push_back(*at);
    }
    for (size_t b = 1; b < later.size(); ++b) {
      for (size_t a = 0; a < b; ++a) {
        if (!FindDirection(spots[later[b]].point - spots[later[a]].point)) continue;
        triangles.push_back({n, later[a], later[b]});
      }
    }
  }
  return triangles;
}

void DropThickSpots(size_t spots, std::vector<SurfaceTriangle>& triangles) {
  UnionFind<uint32_t> pieces(spots);
  for (const SurfaceTriangle& t : triangles) {
    pieces.Unite(t[0], t[1]);
    pieces.Unite(t[0], t[2]);
  }
  std::vector<size_t> many(spots);
  for (const SurfaceTriangle& t : triangles) ++many[pieces.Find(t[0])];
  std::erase_if(triangles, [&](const SurfaceTriangle& t) {
    return many[pieces.Find(t[0])] < kLeastTriangles;
  });
}

// Moves each vertex to the mean of itself and its neighbors, each counted once per triangle.
void SmoothOnce(SheetSurface& sheets) {
  std::vector<WorldPoint> sums = sheets.vertices;
  std::vector<int> many(sums.size(), 1);
  const auto add = [&](uint32_t to, uint32_t from) {
    for (size_t axis = 0; axis < 3; ++axis) sums[to][axis] += sheets.vertices[from][axis];
    ++many[to];
  };
  for (const SurfaceTriangle& t : sheets.triangles) {
    for (size_t n = 0; n < 3; ++n) {
      add(t[n], t[(n + 1) % 3]);
      add(t[n], t[(n + 2) % 3]);
    }
  }
  for (size_t n = 0; n < sums.size(); ++n) {
    for (double& v : sums[n]) v /= many[n];
  }
  sheets.vertices = std::move(sums);
}

}  // namespace

SheetSurface SheetSurfaceOf(const ResultDocument& result) {
  if (!result.placement.has_value() || result.sheets.points.empty()) return {};
  const std::vector<Spot> spots = SpotsOf(result, *result.placement);
  std::vector<SurfaceTriangle> triangles = TrianglesOf(spots);
  DropThickSpots(spots.size(), triangles);
  SheetSurface sheets;
  std::vector<std::optional<uint32_t>> vertex_of(spots.size());
  for (SurfaceTriangle& triangle : triangles) {
    for (uint32_t& corner : triangle) {
      std::optional<uint32_t>& vertex = vertex_of[corner];
      if (!vertex.has_value()) {
        vertex = static_cast<uint32_t>(sheets.vertices.size());
        sheets.vertices.push_back(result.placement->ToWorld(spots[corner].point));
        sheets.radii.push_back(spots[corner].radius);
        if (result.labels.has_value()) sheets.labels.push_back(spots[corner].label);
      }
      corner = *vertex;
    }
  }
  sheets.triangles = std::move(triangles);
  for (int step = 0; step < kSmoothingSteps; ++step) SmoothOnce(sheets);
  return sheets;
}

}  // namespace bccskel::view
