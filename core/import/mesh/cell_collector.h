#ifndef BCCSKEL_CORE_IMPORT_MESH_CELL_COLLECTOR_H_
#define BCCSKEL_CORE_IMPORT_MESH_CELL_COLLECTOR_H_

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "core/import/mesh/data_array.h"
#include "core/import/mesh/mesh_assembler.h"

namespace bccskel {

enum class FaceShape { kPolygon, kStrip };

// Adds points and cells over them, as VTK and GIFTI store both, to a mesh.
class CellCollector {
 public:
  // `format` is for errors.
  CellCollector(std::string_view format, MeshAssembler& mesh) : format_(format), mesh_(mesh) {}

  // Cells count from the first of these points from now on. x, y, z one after the other.
  // Errors: INVALID_ARGUMENT for a number of values that is not three times the points.
  absl::Status AddPoints(const DataArray& values);
  // The cell with these corners.
  // Errors: INVALID_ARGUMENT for a corner that is none of the points.
  absl::Status AddCell(FaceShape shape, const DataArray& corners, size_t begin, size_t end);
  // Cells one behind the other; ends[n] is behind the last corner of cell n.
  // Errors: INVALID_ARGUMENT for ends that go back or do not end with the corners.
  absl::Status AddCells(FaceShape shape, const DataArray& ends, const DataArray& corners);

 private:
  std::string_view format_;
  MeshAssembler& mesh_;
  uint64_t first_ = 0;
  uint64_t points_ = 0;
  std::vector<int64_t> corners_;  // of one cell
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_CELL_COLLECTOR_H_
