#ifndef BCCSKEL_CORE_IMPORT_MESH_SHELL_NESTING_H_
#define BCCSKEL_CORE_IMPORT_MESH_SHELL_NESTING_H_

#include "core/import/mesh/mesh_report.h"

namespace bccskel {

// Finds out which closed components enclose which and fills depth, root, orientation and
// winding_outside of the report's components. A component encloses another when its bounding box
// does and an exact ray from a vertex of the other one crosses it an odd number of times.
// Needs:  the rest of `surface` is filled in and its closure is not kOpen.
// Cost:   one ray per component through the triangles at its height; gives up (nesting_known
//         stays false) where that is more than some 10^9 comparisons.
void FindNesting(Surface& surface);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_SHELL_NESTING_H_
