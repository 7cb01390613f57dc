#include <array>
#include <limits>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/export/surface/border_points.h"
#include "core/export/surface/surface_mesh.h"
#include "core/lattice/directions.h"
#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

// Three mutually adjacent neighbors of a point: with it, a tetrahedron.
using Corners = std::array<Direction, 3>;

std::vector<Corners> TetrahedraAtPoint() {
  std::vector<Corners> tetrahedra;
  const auto adjacent = [](Direction a, Direction b) {
    return (NeighborsAmongN14(a) & b.mask()) != 0;
  };
  for (int a = 0; a < kNeighborCount; ++a) {
    for (int b = a + 1; b < kNeighborCount; ++b) {
      for (int c = b + 1; c < kNeighborCount; ++c) {
        const Corners corners = {Direction(a), Direction(b), Direction(c)};
        if (adjacent(corners[0], corners[1]) && adjacent(corners[0], corners[2]) &&
            adjacent(corners[1], corners[2])) {
          tetrahedra.push_back(corners);
        }
      }
    }
  }
  return tetrahedra;
}

// A tetrahedron that the surface cuts: its corners, relative to one of them, on either side.
struct Cut {
  std::array<LatticePoint, 4> object;  // the smallest first
  std::array<LatticePoint, 3> background;
  size_t object_count = 0;
  size_t background_count = 0;
};

int64_t Determinant(LatticePoint a, LatticePoint b, LatticePoint c) {
  return int64_t{a.x} * (b.y * c.z - b.z * c.y) + int64_t{a.y} * (b.z * c.x - b.x * c.z) +
         int64_t{a.z} * (b.x * c.y - b.y * c.x);
}

class Extractor {
 public:
  Extractor(const BorderPoints& border, SurfaceMesh& mesh) : border_(border), mesh_(mesh) {}

  // Cuts the tetrahedra at a point of which it is the smallest object point.
  void Visit(const BorderPoint& at) {
    static const std::vector<Corners> kTetrahedra = TetrahedraAtPoint();
    for (const Corners& corners : kTetrahedra) {
      Cut cut;
      cut.object[cut.object_count++] = {};
      bool smallest = true;
      for (const Direction d : corners) {
        if ((at.background & d.mask()) != 0) {
          cut.background[cut.background_count++] = d.offset();
        } else {
          cut.object[cut.object_count++] = d.offset();
          smallest = smallest && LatticePoint{} < d.offset();
        }
      }
      if (smallest && cut.background_count > 0) AddCut(at, cut);
    }
  }

 private:
  void AddCut(const BorderPoint& at, const Cut& cut) {
    const auto& o = cut.object;
    const auto& b = cut.background;
    const auto vertex = [&](LatticePoint from, LatticePoint to) {
      return VertexBetween(at, from, to);
    };
    if (cut.object_count == 1) {
      const bool outward = Determinant(b[0], b[1], b[2]) > 0;
      Add(vertex(o[0], b[0]), vertex(o[0], b[1]), vertex(o[0], b[2]), outward);
    } else if (cut.object_count == 3) {
      const bool outward = Determinant(o[1], o[2], b[0]) > 0;
      Add(vertex(o[0], b[0]), vertex(o[1], b[0]), vertex(o[2], b[0]), outward);
    } else {
      const bool outward = Determinant(b[1] - b[0], o[1], b[0]) > 0;
      const uint32_t first = vertex(o[0], b[0]), across = vertex(o[1], b[1]);
      Add(first, vertex(o[0], b[1]), across, outward);
      Add(first, across, vertex(o[1], b[0]), outward);
    }
  }

  // The vertex between an object and a background corner, both relative to `at`.
  uint32_t VertexBetween(const BorderPoint& at, LatticePoint from, LatticePoint to) const {
    const BorderPoint& owner = from == LatticePoint{} ? at : border_.At(at.point + from);
    return static_cast<uint32_t>(BorderPoints::VertexOf(owner, *FindDirection(to - from)));
  }

  void Add(uint32_t a, uint32_t b, uint32_t c, bool counterclockwise) {
    if (!counterclockwise) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
  }

  const BorderPoints& border_;
  SurfaceMesh& mesh_;
};

// The middle of every step from a border point to the background.
void AddVertices(const BorderPoint& at, std::vector<SurfaceVertex>& vertices) {
  ForEachDirection(at.background, [&](Direction d) {
    const auto middle = [](int32_t p, int32_t step) {
      return static_cast<float>(p) + static_cast<float>(step) / 2;
    };
    vertices.push_back({middle(at.point.x, d.offset().x), middle(at.point.y, d.offset().y),
                        middle(at.point.z, d.offset().z)});
  });
}

}  // namespace

absl::StatusOr<SurfaceMesh> ExtractSurface(const Volume& object, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const BorderPoints border, BorderPoints::Find(object, context));
  constexpr uint64_t kMostVertices = std::numeric_limits<uint32_t>::max();
  if (border.vertex_count() > kMostVertices) {
    return absl::ResourceExhaustedError(absl::StrFormat(
        "the surface has %d vertices; the limit is %d", border.vertex_count(), kMostVertices));
  }
  SurfaceMesh mesh;
  mesh.vertices.reserve(border.vertex_count());
  mesh.triangles.reserve(2 * border.vertex_count());
  Extractor extractor(border, mesh);
  for (size_t n = 0; n < border.points().size(); ++n) {
    if (n % 8192 == 0 && context.ShouldStop()) return context.StopStatus();
    AddVertices(border.points()[n], mesh.vertices);
    extractor.Visit(border.points()[n]);
  }
  return mesh;
}

}  // namespace bccskel
