#include "client/export/picture/band.h"

#include <algorithm>
#include <cmath>

namespace bccskel::exporting {
namespace {

// The samples of a band that an interval of coordinates covers; sample n lies at n.
struct Span {
  int begin;
  int end;
};
Span SpanOf(float low, float high, int first, int count) {
  // Clamped to numbers from 0 on, which are faster to truncate than to round.
  const auto start = static_cast<float>(first), end = static_cast<float>(first + count);
  const float least = std::clamp(low, start, end), beyond = std::clamp(high + 1, start, end);
  const auto begin = static_cast<int>(least);
  return {begin + (static_cast<float>(begin) < least), static_cast<int>(beyond)};
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
  for (Hits* hits : {&near_, &far_, &bead_}) {
    hits->depths.assign(samples, -kNothing);
    hits->looks.resize(samples);
  }
  far_.depths.assign(samples, kNothing);
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

void Band::DrawGlass(const Geometry& geometry, std::span<const uint32_t> triangles) {
  for (const uint32_t n : triangles) {
    const SurfaceTriangle& triangle = geometry.glass.triangles[n];
    const LinearColor& tint = geometry.tints.empty() ? kGlassTint : geometry.tints[n];
    ForEachSample(geometry.glass, triangle, [&](size_t at, float depth, const Weights& weights) {
      if (depth <= near_.depths[at] && depth >= far_.depths[at]) return;
      const Hit hit = {depth, Mean(geometry.normals, triangle, weights), tint};
      if (hit.depth > near_.depths[at]) near_.Set(at, hit);
      if (hit.depth < far_.depths[at]) far_.Set(at, hit);
    });
  }
}

void Band::DrawBeads(const std::vector<Bead>& beads, std::span<const uint32_t> some) {
  for (const uint32_t n : some) DrawBead(beads[n]);
}

void Band::DrawSheets(const SheetGeometry& sheets) {
  for (const SurfaceTriangle& triangle : sheets.mesh.triangles) {
    ForEachSample(sheets.mesh, triangle, [&](size_t at, float depth, const Weights& weights) {
      if (depth <= bead_.depths[at]) return;
      bead_.Set(at, {depth, Mean(sheets.normals, triangle, weights),
                     Mean(sheets.colors, triangle, weights)});
    });
  }
}

void Band::DrawBead(const Bead& bead) {
  const Span rows = SpanOf(bead.y - bead.radius, bead.y + bead.radius, top_, rows_);
  const Span columns = SpanOf(bead.x - bead.radius, bead.x + bead.radius, 0, width_);
  if (rows.begin >= rows.end || columns.begin >= columns.end) return;
  const float nearest = bead.depth + bead.radius, per_sample = 1 / bead.radius;
  for (int y = rows.begin; y < rows.end; ++y) {
    const float dy = (bead.y - static_cast<float>(y)) * per_sample;
    size_t at = Index(columns.begin, y - top_);
    for (int x = columns.begin; x < columns.end; ++x, ++at) {
      const float hidden = bead_.depths[at];
      if (nearest <= hidden) continue;
      const float dx = (static_cast<float>(x) - bead.x) * per_sample;
      const float rest = 1 - dx * dx - dy * dy;
      if (rest < 0) continue;
      const float rise = std::sqrt(rest), depth = bead.depth + bead.radius * rise;
      if (depth > hidden) bead_.Set(at, {depth, {dx, dy, rise}, bead.color});
    }
  }
}

}  // namespace bccskel::exporting
