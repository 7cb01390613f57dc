#ifndef BCCSKEL_CORE_IMPORT_MESH_SHELL_NESTING_H_
#define BCCSKEL_CORE_IMPORT_MESH_SHELL_NESTING_H_

#include "core/import/mesh/mesh_report.h"

namespace bccskel {

// Finds out which closed components enclose which and fills depth, root, orientation and
// winding_outside of the report's components. A component encloses another when its bounding box
// does and exact rays from the other's extreme vertices along x, y and z cross it an odd number of
// times each. (With one ray, a rung between two posts might seem to lie inside a post.)
// Needs:  the rest of `surface` is filled in and its closure is not kOpen.
// Cost:   up to six rays per component through the triangles at its height; gives up (nesting_known
//         stays false) where that is more than some 10^9 comparisons.
void FindNesting(Surface& surface);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_SHELL_NESTING_H_
