#include "tests/core/import/mesh/mesh_shapes.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "absl/strings/str_format.h"
#include "core/lattice/vectors.h"

namespace bccskel::testing {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// A grid of quads that closes in both directions.
TriangleMesh ClosedTube(int around, int across, const std::function<Vertex(double, double)>& at) {
  TriangleMesh mesh;
  for (int u = 0; u < around; ++u) {
    for (int v = 0; v < across; ++v)
      mesh.vertices.push_back(at(kTurn * u / around, kTurn * v / across));
  }
  const auto index = [&](int u, int v) {
    return static_cast<uint32_t>((u % around) * across + v % across);
  };
  for (int u = 0; u < around; ++u) {
    for (int v = 0; v < across; ++v) {
      mesh.triangles.push_back({index(u, v), index(u + 1, v), index(u + 1, v + 1)});
      mesh.triangles.push_back({index(u, v), index(u + 1, v + 1), index(u, v + 1)});
    }
  }
  return mesh;
}

void AppendRaw(std::string& bytes, uint64_t raw, int size, PlyKind kind) {
  for (int n = 0; n < size; ++n) {
    const int shift = 8 * (kind == PlyKind::kBigEndian ? size - 1 - n : n);
    bytes.push_back(static_cast<char>(raw >> shift & 0xFF));
  }
}

void AppendFloat(std::string& bytes, double value) {
  AppendRaw(bytes, std::bit_cast<uint32_t>(static_cast<float>(value)), 4, PlyKind::kLittleEndian);
}

std::string Line(const char* before, const Vertex& v) {
  return absl::StrFormat("%s%.17g %.17g %.17g\n", before, v[0], v[1], v[2]);
}

}  // namespace

TriangleMesh Box(Vertex lower, Vertex upper) {
  TriangleMesh mesh;
  for (size_t n = 0; n < 8; ++n) {
    mesh.vertices.push_back(
        {(n & 1 ? upper : lower)[0], (n & 2 ? upper : lower)[1], (n & 4 ? upper : lower)[2]});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh Tetrahedron(Vertex a, Vertex b, Vertex c, Vertex d) {
  TriangleMesh mesh = {{a, b, c, d}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  const auto edge = [&](size_t n) {
    const Vertex& v = mesh.vertices[n];
    return Vertex{v[0] - a[0], v[1] - a[1], v[2] - a[2]};
  };
  const Vertex normal = Cross(edge(1), edge(2)), up = edge(3);
  return normal[0] * up[0] + normal[1] * up[1] + normal[2] * up[2] < 0 ? Flipped(mesh) : mesh;
}

TriangleMesh Sphere(Vertex center, double radius, int rings) {
  TriangleMesh mesh;
  const int around = 2 * rings;
  mesh.vertices.push_back({center[0], center[1], center[2] + radius});
  for (int ring = 1; ring < rings; ++ring) {
    for (int n = 0; n < around; ++n) {
      const double theta = kTurn / 2 * ring / rings, phi = kTurn * n / around;
      mesh.vertices.push_back({center[0] + radius * std::sin(theta) * std::cos(phi),
                               center[1] + radius * std::sin(theta) * std::sin(phi),
                               center[2] + radius * std::cos(theta)});
    }
  }
  mesh.vertices.push_back({center[0], center[1], center[2] - radius});
  const auto south = static_cast<uint32_t>(mesh.vertices.size() - 1);
  const auto index = [&](int ring, int n) {
    return static_cast<uint32_t>(1 + (ring - 1) * around + n % around);
  };
  for (int n = 0; n < around; ++n) {
    mesh.triangles.push_back({0, index(1, n), index(1, n + 1)});
    mesh.triangles.push_back({south, index(rings - 1, n + 1), index(rings - 1, n)});
    for (int ring = 1; ring + 1 < rings; ++ring) {
      mesh.triangles.push_back({index(ring, n), index(ring + 1, n), index(ring + 1, n + 1)});
      mesh.triangles.push_back({index(ring, n), index(ring + 1, n + 1), index(ring, n + 1)});
    }
  }
  return mesh;
}

TriangleMesh Torus(double ring_radius, double tube_radius, int around, int across) {
  return ClosedTube(around, across, [=](double u, double v) {
    const double r = ring_radius + tube_radius * std::cos(v);
    return Vertex{r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v)};
  });
}

TriangleMesh TrefoilTube(double tube_radius, int around, int across) {
  const auto curve = [](double t) {
    return Vertex{std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t),
                  -std::sin(3 * t)};
  };
  const auto tangent = [](double t) {
    return Unit(Vertex{std::cos(t) + 4 * std::cos(2 * t), -std::sin(t) + 4 * std::sin(2 * t),
                       -3 * std::cos(3 * t)});
  };
  return ClosedTube(around, across, [=](double u, double v) {
    const Vertex along = tangent(u), side = Unit(Cross(along, {0, 0, 1}));
    const Vertex up = Cross(side, along), middle = curve(u);
    Vertex at;
    for (size_t axis = 0; axis < 3; ++axis) {
      at[axis] = middle[axis] + tube_radius * (std::cos(v) * side[axis] + std::sin(v) * up[axis]);
    }
    return at;
  });
}

TriangleMesh Blade(double height) {
  TriangleMesh mesh;
  for (const double z : {-2.0, 2.0}) {
    mesh.vertices.insert(mesh.vertices.end(), {{-1, 0, z}, {1, 0, z}, {0, height, z}});
  }
  mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                    {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return mesh;
}

TriangleMesh Turned(TriangleMesh mesh, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::array<double, 4> q;
  for (double& part : q) part = normal(random);
  const double size = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  for (double& part : q) part /= size;
  const auto [w, x, y, z] = q;
  for (auto& v : mesh.vertices) {
    const auto [a, b, c] = v;
    v = {(1 - 2 * (y * y + z * z)) * a + 2 * (x * y - w * z) * b + 2 * (x * z + w * y) * c,
         2 * (x * y + w * z) * a + (1 - 2 * (x * x + z * z)) * b + 2 * (y * z - w * x) * c,
         2 * (x * z - w * y) * a + 2 * (y * z + w * x) * b + (1 - 2 * (x * x + y * y)) * c};
  }
  return mesh;
}

TriangleMesh Flipped(TriangleMesh mesh) {
  for (TriangleMesh::Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh Merged(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh mesh = a;
  const auto shift = static_cast<uint32_t>(a.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [u, v, w] : b.triangles)
    mesh.triangles.push_back({u + shift, v + shift, w + shift});
  return mesh;
}

TriangleMesh Moved(TriangleMesh mesh, double scale, Vertex offset) {
  for (Vertex& v : mesh.vertices) {
    for (size_t axis = 0; axis < 3; ++axis) v[axis] = v[axis] * scale + offset[axis];
  }
  return mesh;
}

TriangleMesh Unshared(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const TriangleMesh::Triangle& t : mesh.triangles) {
    const auto first = static_cast<uint32_t>(soup.vertices.size());
    for (uint32_t corner : t) soup.vertices.push_back(mesh.vertices[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

std::string ToOff(const TriangleMesh& mesh) {
  std::string text = absl::StrFormat("OFF\n%d %d 0\n", mesh.vertices.size(), mesh.triangles.size());
  for (const Vertex& v : mesh.vertices) text += Line("", v);
  for (const auto& [a, b, c] : mesh.triangles) text += absl::StrFormat("3 %d %d %d\n", a, b, c);
  return text;
}

std::string ToObj(const TriangleMesh& mesh) {
  std::string text;
  for (const Vertex& v : mesh.vertices) text += Line("v ", v);
  for (const auto& [a, b, c] : mesh.triangles) {
    text += absl::StrFormat("f %d %d %d\n", a + 1, b + 1, c + 1);
  }
  return text;
}

std::string ToAsciiStl(const TriangleMesh& mesh) {
  std::string text = "solid test\n";
  for (const TriangleMesh::Triangle& t : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (uint32_t corner : t) text += Line("vertex ", mesh.vertices[corner]);
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid test\n";
}

std::string ToBinaryStl(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  AppendRaw(bytes, mesh.triangles.size(), 4, PlyKind::kLittleEndian);
  for (const TriangleMesh::Triangle& t : mesh.triangles) {
    bytes.append(12, '\0');
    for (uint32_t corner : t) {
      for (double coordinate : mesh.vertices[corner]) AppendFloat(bytes, coordinate);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string ToPly(const TriangleMesh& mesh, PlyKind kind) {
  const char* encoding = kind == PlyKind::kAscii       ? "ascii"
                         : kind == PlyKind::kBigEndian ? "binary_big_endian"
                                                       : "binary_little_endian";
  std::string bytes = absl::StrFormat(
      "ply\nformat %s 1.0\ncomment test\nelement vertex %d\nproperty double x\nproperty double y\n"
      "property double z\nelement face %d\nproperty list uchar int vertex_indices\nend_header\n",
      encoding, mesh.vertices.size(), mesh.triangles.size());
  for (const Vertex& v : mesh.vertices) {
    if (kind == PlyKind::kAscii) bytes += Line("", v);
    if (kind == PlyKind::kAscii) continue;
    for (double c : v) AppendRaw(bytes, std::bit_cast<uint64_t>(c), 8, kind);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    if (kind == PlyKind::kAscii) bytes += absl::StrFormat("3 %d %d %d\n", a, b, c);
    if (kind == PlyKind::kAscii) continue;
    bytes.push_back(3);
    for (uint32_t corner : {a, b, c}) AppendRaw(bytes, corner, 4, kind);
  }
  return bytes;
}

}  // namespace bccskel::testing
