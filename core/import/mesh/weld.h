#ifndef BCCSKEL_CORE_IMPORT_MESH_WELD_H_
#define BCCSKEL_CORE_IMPORT_MESH_WELD_H_

#include "core/import/mesh/triangle_mesh.h"

namespace bccskel {

// Joins vertices with exactly equal coordinates. The joined vertices keep the order of their first
// appearance; triangles keep their order and may name one vertex twice afterwards.
TriangleMesh WeldVertices(const TriangleMesh& mesh);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_WELD_H_
