#include "core/import/mesh/gltf_transform.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

using Column = TriangleMesh::Vertex;

// Of a quaternion x, y, z, w of any length; files round it.
std::array<Column, 3> RotationOf(const std::vector<double>& q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
           {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
           {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}}};
}

}  // namespace

absl::StatusOr<GltfTransform> GltfTransform::Of(const GltfItem& node) {
  GltfTransform transform;
  auto& columns = transform.columns_;
  if (node.Has("matrix")) {
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<double> matrix, node.Numbers("matrix", 16));
    for (size_t n = 0; n < 4; ++n)
      columns[n] = {matrix[4 * n], matrix[4 * n + 1], matrix[4 * n + 2]};
    return transform;
  }
  if (node.Has("rotation")) {
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<double> rotation, node.Numbers("rotation", 4));
    const auto turned = RotationOf(rotation);
    std::copy(turned.begin(), turned.end(), columns.begin());
  }
  if (node.Has("scale")) {
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<double> scale, node.Numbers("scale", 3));
    for (size_t n = 0; n < 3; ++n) {
      for (double& value : columns[n]) value *= scale[n];
    }
  }
  if (node.Has("translation")) {
    BCCSKEL_ASSIGN_OR_RETURN(const std::vector<double> shift, node.Numbers("translation", 3));
    columns[3] = {shift[0], shift[1], shift[2]};
  }
  return transform;
}

TriangleMesh::Vertex GltfTransform::Turn(const TriangleMesh::Vertex& direction) const {
  Column turned = {};
  for (size_t row = 0; row < 3; ++row) {
    turned[row] = columns_[0][row] * direction[0] + columns_[1][row] * direction[1] +
                  columns_[2][row] * direction[2];
  }
  return turned;
}

TriangleMesh::Vertex GltfTransform::Apply(const TriangleMesh::Vertex& place) const {
  Column moved = Turn(place);
  for (size_t row = 0; row < 3; ++row) moved[row] += columns_[3][row];
  return moved;
}

GltfTransform GltfTransform::After(const GltfTransform& inner) const {
  GltfTransform both;
  for (size_t n = 0; n < 3; ++n) both.columns_[n] = Turn(inner.columns_[n]);
  both.columns_[3] = Apply(inner.columns_[3]);
  return both;
}

bool GltfTransform::Mirrors() const {
  const auto& [a, b, c, shift] = columns_;
  const double volume = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
                        a[2] * (b[0] * c[1] - b[1] * c[0]);
  return volume < 0;
}

}  // namespace bccskel
