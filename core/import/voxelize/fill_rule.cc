#include "core/import/voxelize/fill_rule.h"

#include "absl/strings/str_format.h"

namespace bccskel {
namespace {

// Up to this share of the surface, holes hardly leave a doubt about the inside.
constexpr double kMostHoles = 0.1;
// Of an open mesh that is filled without being asked for: the share of the edges between triangles
// that turn against each other. A few wrong triangles hardly change winding numbers.
constexpr double kMostMisoriented = 0.01;

std::string DescribeDefects(const MeshReport& mesh) {
  const auto counted = [](uint64_t edges, const char* kind) {
    return absl::StrFormat("%d %s %s", edges, kind, edges == 1 ? "edge" : "edges");
  };
  std::string edges = counted(mesh.boundary_edges, "boundary") + ", " +
                      counted(mesh.non_manifold_edges, "non-manifold") + ", " +
                      counted(mesh.misoriented_edges, "misoriented");
  if (mesh.closure != SurfaceClosure::kOpen) return edges;
  const double percent = 100 * mesh.hole_share;
  if (percent < 0.01) return edges + "; holes: less than 0.01 % of the surface";
  return edges + absl::StrFormat("; holes: %.*f %% of the surface", percent < 1 ? 2 : 0, percent);
}

// Shells inside a shell of the same orientation: solid for one rule, cavities for the other.
int64_t CountAmbiguousShells(const MeshReport& mesh) {
  int64_t count = 0;
  for (const SurfaceComponent& component : mesh.components) {
    const bool in_winding = component.winding_outside != 0;
    const bool in_parity = component.depth % 2 != 0;
    const bool winding_wall =
        in_winding != (component.winding_outside + component.orientation != 0);
    count += in_winding != in_parity || !winding_wall ? 1 : 0;
  }
  return count;
}

}  // namespace

absl::StatusOr<FillRule> ChooseFillRule(const MeshReport& mesh, FillRule wanted) {
  const bool open = mesh.closure == SurfaceClosure::kOpen;
  if (open && wanted == FillRule::kAuto) {
    const double misoriented = static_cast<double>(mesh.misoriented_edges);
    const bool turns_one_way = misoriented <= kMostMisoriented * static_cast<double>(mesh.edges);
    if (mesh.hole_share <= kMostHoles && turns_one_way) return FillRule::kWinding;
    const char* const what = mesh.two_sided_triangles == 0
                                 ? "the mesh"
                                 : "nothing enclosed: every triangle is there from both sides, and "
                                   "one side alone";
    return absl::FailedPreconditionError(absl::StrFormat(
        "%s is not closed (%s); repair it or fill it by winding number (--fill winding)", what,
        DescribeDefects(mesh)));
  }
  if (open && wanted == FillRule::kParity) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "parity needs a closed mesh, this one has %s; repair it or use --fill winding",
        DescribeDefects(mesh)));
  }
  if (wanted == FillRule::kWinding && mesh.closure == SurfaceClosure::kClosed) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "winding needs a consistently oriented mesh, this one has %s: use --fill parity",
        DescribeDefects(mesh)));
  }
  if (wanted != FillRule::kAuto) return wanted;
  return mesh.closure == SurfaceClosure::kOriented ? FillRule::kWinding : FillRule::kParity;
}

std::vector<std::string> DefectWarnings(const MeshReport& mesh, FillRule rule) {
  std::vector<std::string> warnings;
  if (mesh.closure == SurfaceClosure::kOpen) {
    warnings.push_back(absl::StrFormat(
        "the mesh is not closed (%s): filled where its generalized winding number exceeds 1/2",
        DescribeDefects(mesh)));
  } else if (mesh.closure == SurfaceClosure::kClosed) {
    warnings.push_back(
        absl::StrFormat("the mesh is not consistently oriented (%d edges): filled by parity",
                        mesh.misoriented_edges));
  }
  if (mesh.closure == SurfaceClosure::kOriented && CountAmbiguousShells(mesh) > 0) {
    warnings.push_back(absl::StrFormat(
        "%d %s inside a shell of the same orientation: %s", CountAmbiguousShells(mesh),
        CountAmbiguousShells(mesh) == 1 ? "shell lies" : "shells lie",
        rule == FillRule::kWinding ? "filled (parity would make them cavities)"
                                   : "taken as cavities (winding would fill them)"));
  }
  if (mesh.two_sided_triangles > 0) {
    warnings.push_back(
        absl::StrFormat("the mesh has all %d triangles from both sides; one of each was kept",
                        mesh.two_sided_triangles));
  }
  if (mesh.dropped_triangles > 0) {
    warnings.push_back(
        absl::StrFormat("%d degenerate %s dropped", mesh.dropped_triangles,
                        mesh.dropped_triangles == 1 ? "triangle was" : "triangles were"));
  }
  return warnings;
}

std::optional<SolidTopology> ExpectedTopology(const MeshReport& mesh, FillRule rule) {
  return rule == FillRule::kParity ? mesh.SolidByParity() : mesh.SolidByWinding();
}

}  // namespace bccskel
