#include "client/export/picture/band.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bccskel::exporting {
namespace {

// The samples of a band that an interval of coordinates covers; sample n lies at n.
struct Span {
  int begin;
  int end;
};
Span SpanOf(float low, float high, int first, int count) {
  const float last = static_cast<float>(first + count - 1);
  return {static_cast<int>(std::ceil(std::clamp(low, static_cast<float>(first), last + 1))),
          static_cast<int>(std::floor(std::clamp(high, static_cast<float>(first) - 1, last))) + 1};
}

using Weights = std::array<float, 3>;

// The weighted mean of a triangle's corners.
std::array<float, 3> Mean(const std::vector<std::array<float, 3>>& of,
                          const SurfaceTriangle& triangle, const Weights& weights) {
  std::array<float, 3> mean = {};
  for (size_t n = 0; n < 3; ++n) {
    for (size_t part = 0; part < 3; ++part) mean[part] += weights[n] * of[triangle[n]][part];
  }
  return mean;
}

}  // namespace

Band::Band(int width, int top, int rows) : width_(width), top_(top), rows_(rows) {
  const size_t samples = Index(0, rows);
  near_.assign(samples, {-kNothing, {}, {}});
  far_.assign(samples, {kNothing, {}, {}});
  bead_.assign(samples, {-kNothing, {}, {}});
}

void Band::Draw(const Geometry& geometry) {
  std::vector<uint32_t> all(geometry.beads.size());
  std::iota(all.begin(), all.end(), 0);
  Draw(geometry, all);
}

void Band::Draw(const Geometry& geometry, std::span<const uint32_t> beads) {
  for (size_t n = 0; n < geometry.glass.triangles.size(); ++n) DrawGlass(geometry, n);
  for (const uint32_t n : beads) DrawBead(geometry.beads[n]);
  for (const SurfaceTriangle& t : geometry.sheets.mesh.triangles) DrawSheet(geometry.sheets, t);
}

// Calls visit(index, depth, weights) for each sample that a triangle covers: its depth there and
// the weights of the corners.
template <typename Visit>
void Band::ForEachSample(const SurfaceMesh& mesh, const SurfaceTriangle& triangle,
                         Visit visit) const {
  const SurfaceVertex& a = mesh.vertices[triangle[0]];
  const SurfaceVertex& b = mesh.vertices[triangle[1]];
  const SurfaceVertex& c = mesh.vertices[triangle[2]];
  const Span rows =
      SpanOf(std::min({-a[1], -b[1], -c[1]}), std::max({-a[1], -b[1], -c[1]}), top_, rows_);
  const float area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
  if (rows.begin >= rows.end || area == 0) return;
  const Span columns =
      SpanOf(std::min({a[0], b[0], c[0]}), std::max({a[0], b[0], c[0]}), 0, width_);
  for (int y = rows.begin; y < rows.end; ++y) {
    for (int x = columns.begin; x < columns.end; ++x) {
      const float dx = static_cast<float>(x) - a[0], dy = static_cast<float>(-y) - a[1];
      const float v = (dx * (c[1] - a[1]) - dy * (c[0] - a[0])) / area;
      const float w = (dy * (b[0] - a[0]) - dx * (b[1] - a[1])) / area;
      const float u = 1 - v - w;
      if (u < 0 || v < 0 || w < 0) continue;
      visit(Index(x, y - top_), u * a[2] + v * b[2] + w * c[2], Weights{u, v, w});
    }
  }
}

void Band::DrawGlass(const Geometry& geometry, size_t n) {
  const SurfaceTriangle& triangle = geometry.glass.triangles[n];
  const LinearColor& tint = geometry.tints.empty() ? kGlassTint : geometry.tints[n];
  ForEachSample(geometry.glass, triangle, [&](size_t at, float depth, const Weights& weights) {
    const Hit hit = {depth, Mean(geometry.normals, triangle, weights), tint};
    if (hit.depth > near_[at].depth) near_[at] = hit;
    if (hit.depth < far_[at].depth) far_[at] = hit;
  });
}

void Band::DrawSheet(const SheetGeometry& sheets, const SurfaceTriangle& triangle) {
  ForEachSample(sheets.mesh, triangle, [&](size_t at, float depth, const Weights& weights) {
    if (depth <= bead_[at].depth) return;
    bead_[at] = {depth, Mean(sheets.normals, triangle, weights),
                 Mean(sheets.colors, triangle, weights)};
  });
}

void Band::DrawBead(const Bead& bead) {
  const Span rows = SpanOf(bead.y - bead.radius, bead.y + bead.radius, top_, rows_);
  const Span columns = SpanOf(bead.x - bead.radius, bead.x + bead.radius, 0, width_);
  for (int y = rows.begin; y < rows.end; ++y) {
    for (int x = columns.begin; x < columns.end; ++x) {
      const float dx = (static_cast<float>(x) - bead.x) / bead.radius;
      const float dy = (bead.y - static_cast<float>(y)) / bead.radius;
      const float rest = 1 - dx * dx - dy * dy;
      if (rest < 0) continue;
      const float rise = std::sqrt(rest);
      const size_t at = Index(x, y - top_);
      if (bead.depth + bead.radius * rise <= bead_[at].depth) continue;
      bead_[at] = {bead.depth + bead.radius * rise, {dx, dy, rise}, bead.color};
    }
  }
}

}  // namespace bccskel::exporting
