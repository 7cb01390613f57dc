#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_FILL_RULE_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_FILL_RULE_H_

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "core/import/mesh/mesh_report.h"

namespace bccskel {

// Which points are inside.
//
// kAuto     closed and consistently oriented surfaces: kWinding. Closed ones with inconsistent
//           orientation: kParity, with a warning. Open ones whose holes make up at most a tenth of
//           the surface, and of whose edges at most a hundredth lie between triangles that turn
//           against each other: kWinding, with a warning; other open ones are refused.
// kParity   inside where a ray crosses the surface an odd number of times. Needs a closed surface.
//           Where parts overlap there is a hole; a nested shell is a cavity whatever its
//           orientation; a part given twice vanishes.
// kWinding  inside where the winding number is not 0. Each outermost component and all that it
//           encloses are first turned so that the outermost one points outward, so inverted meshes
//           give the same bits. Overlapping parts are joined; a nested shell is a cavity when it
//           is oriented against the shell around it, and changes nothing when it is oriented alike.
//           Closed surfaces of inconsistent orientation are refused. Open ones, and those with odd
//           edges, are filled where the generalized winding number (Jacobson, Kavan,
//           Sorkine-Hornung 2013) exceeds 1/2, after turning the mesh so that its volume is
//           positive, with a warning.
enum class FillRule { kAuto, kParity, kWinding };

// The rule that is used where `wanted` is asked for; never kAuto.
// Errors: FAILED_PRECONDITION (kAuto, open mesh), INVALID_ARGUMENT (kParity for an open mesh, or
//         kWinding for a closed one of inconsistent orientation).
absl::StatusOr<FillRule> ChooseFillRule(const MeshReport& mesh, FillRule wanted);

// What a person should know when the mesh is filled by this rule although it has defects.
std::vector<std::string> DefectWarnings(const MeshReport& mesh, FillRule rule);

// The solid that the rule makes of the surface, where the surface alone says it.
std::optional<SolidTopology> ExpectedTopology(const MeshReport& mesh, FillRule rule);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_FILL_RULE_H_
