#ifndef BCCSKEL_TESTS_CORE_IMPORT_MESH_MESH_BYTES_H_
#define BCCSKEL_TESTS_CORE_IMPORT_MESH_MESH_BYTES_H_

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "core/import/mesh/triangle_mesh.h"

namespace bccskel::testing {

// x, y, z of all vertices; the corners of all triangles.
template <typename Number>
std::vector<Number> CoordinatesOf(const TriangleMesh& mesh) {
  std::vector<Number> values;
  for (const auto& vertex : mesh.vertices) {
    for (const double value : vertex) values.push_back(static_cast<Number>(value));
  }
  return values;
}
template <typename Number>
std::vector<Number> CornersOf(const TriangleMesh& mesh) {
  std::vector<Number> values;
  for (const auto& triangle : mesh.triangles) {
    for (const uint32_t corner : triangle) values.push_back(static_cast<Number>(corner));
  }
  return values;
}

// The bytes of the numbers in a file.
template <typename Number>
std::string BytesOf(const std::vector<Number>& numbers, std::endian order = std::endian::little) {
  std::string bytes;
  for (const Number number : numbers) {
    std::string one(sizeof number, '\0');
    std::memcpy(one.data(), &number, sizeof number);
    if (order != std::endian::native) std::ranges::reverse(one);
    bytes += one;
  }
  return bytes;
}

// As text, with all digits.
template <typename Number>
std::string TextOf(const std::vector<Number>& numbers) {
  std::string text;
  for (const Number number : numbers) text += std::to_string(number) + ' ';
  return text;
}

}  // namespace bccskel::testing

#endif  // BCCSKEL_TESTS_CORE_IMPORT_MESH_MESH_BYTES_H_
