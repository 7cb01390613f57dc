#include "core/import/voxelize/solid_fill.h"

#include <utility>

#include "core/import/mesh/boundary_loops.h"
#include "core/import/voxelize/generalized_winding.h"
#include "core/import/voxelize/row_fill.h"
#include "core/import/voxelize/thin_parts.h"

namespace bccskel {
namespace {

class ParityRule : public SegmentRule {
 public:
  void Append(const LatticeRow&, CellSpan segment, int, int crossings,
              std::vector<CellSpan>& inside) const override {
    if (crossings % 2 != 0) inside.push_back(segment);
  }
};

class WindingRule : public SegmentRule {
 public:
  void Append(const LatticeRow&, CellSpan segment, int winding, int,
              std::vector<CellSpan>& inside) const override {
    if (winding != 0) inside.push_back(segment);
  }
};

// So that every root component turns outward.
std::vector<int8_t> SignsByComponent(const Surface& surface) {
  std::vector<int8_t> signs(surface.triangles.size());
  const std::vector<SurfaceComponent>& components = surface.report.components;
  for (size_t t = 0; t < signs.size(); ++t) {
    const SurfaceComponent& root = components[components[surface.component_of[t]].root];
    signs[t] = root.volume < 0 ? -1 : 1;
  }
  return signs;
}

double SignedVolume(std::span<const TriangleMesh::Vertex> vertices,
                    std::span<const TriangleMesh::Triangle> triangles) {
  double volume = 0;
  for (const auto& [u, v, w] : triangles) {
    const auto &a = vertices[u], &b = vertices[v], &c = vertices[w];
    volume += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
              a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return volume / 6;
}

}  // namespace

SolidFill::SolidFill(const Surface& surface, FillRule rule, uint64_t max_points)
    : surface_(surface),
      rule_(rule),
      max_points_(max_points),
      triangles_(surface.triangles),
      signs_(SignsByComponent(surface)) {
  if (surface.report.closure == SurfaceClosure::kOpen) AddCaps();
}

void SolidFill::AddCaps() {
  const std::vector<TriangleMesh::Triangle> caps = CapsOf(surface_.boundary_loops);
  triangles_.insert(triangles_.end(), caps.begin(), caps.end());
  const int8_t sign = SignedVolume(surface_.vertices, triangles_) < 0 ? -1 : 1;
  signs_.assign(triangles_.size(), sign);
}

FillRequest SolidFill::RequestOn(const GridFit& fit) const {
  FillRequest request = {fit.extent, fit.placement, {}, triangles_, signs_, max_points_};
  request.vertices.reserve(surface_.vertices.size());
  for (const auto& vertex : surface_.vertices) request.vertices.push_back(fit.Snap(vertex));
  return request;
}

absl::StatusOr<Volume> SolidFill::Fill(const FillRequest& request,
                                       const exec::Context& context) const {
  if (rule_ == FillRule::kParity) return FillRows(request, ParityRule(), context);
  if (surface_.boundary_loops.empty()) return FillRows(request, WindingRule(), context);
  const GeneralizedWindingRule rule(request.vertices, surface_.boundary_loops, request.extent,
                                    signs_.front());
  return FillRows(request, rule, context);
}

absl::StatusOr<Volume> SolidFill::KeepThinParts(Volume sampling, const FillRequest& request,
                                                const exec::Context& context) const {
  if (rule_ == FillRule::kParity) return sampling;
  return WithThinParts(std::move(sampling), request, surface_.triangles.size(), context);
}

}  // namespace bccskel
