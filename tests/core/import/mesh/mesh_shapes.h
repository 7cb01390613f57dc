#ifndef BCCSKEL_TESTS_CORE_IMPORT_MESH_MESH_SHAPES_H_
#define BCCSKEL_TESTS_CORE_IMPORT_MESH_MESH_SHAPES_H_

#include <array>
#include <random>
#include <string>

#include "core/import/mesh/triangle_mesh.h"

namespace bccskel::testing {

using Vertex = TriangleMesh::Vertex;

// Closed surfaces with outward normals.
TriangleMesh Box(Vertex lower, Vertex upper);
TriangleMesh Tetrahedron(Vertex a, Vertex b, Vertex c, Vertex d);
TriangleMesh Sphere(Vertex center, double radius, int rings = 24);
TriangleMesh Torus(double ring_radius, double tube_radius, int around = 48, int across = 24);
// A tube around the trefoil knot: genus 1.
TriangleMesh TrefoilTube(double tube_radius, int around = 240, int across = 12);

// A prism of length 4 over a triangle of width 2 and this height: its two long edges are sharp.
TriangleMesh Blade(double height);

// Turned about the origin at random.
TriangleMesh Turned(TriangleMesh mesh, std::mt19937& random);
TriangleMesh Flipped(TriangleMesh mesh);
TriangleMesh Merged(const TriangleMesh& a, const TriangleMesh& b);
// Every coordinate times `scale`, plus the offset.
TriangleMesh Moved(TriangleMesh mesh, double scale, Vertex offset);
// Three corners of its own for each triangle.
TriangleMesh Unshared(const TriangleMesh& mesh);

// The bytes of a file of each format. Text has all digits.
std::string ToOff(const TriangleMesh& mesh);
std::string ToObj(const TriangleMesh& mesh);
std::string ToAsciiStl(const TriangleMesh& mesh);
std::string ToBinaryStl(const TriangleMesh& mesh);
enum class PlyKind { kAscii, kLittleEndian, kBigEndian };
std::string ToPly(const TriangleMesh& mesh, PlyKind kind);

}  // namespace bccskel::testing

#endif  // BCCSKEL_TESTS_CORE_IMPORT_MESH_MESH_SHAPES_H_
