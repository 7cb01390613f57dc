#include "core/import/mesh/cell_collector.h"

#include <cmath>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {

absl::Status CellCollector::AddPoints(const DataArray& values) {
  if (values.size() % 3 != 0) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s: %d coordinates are not three for each point", format_, values.size()));
  }
  first_ = mesh_.vertex_count();
  points_ = values.size() / 3;
  for (size_t n = 0; n < values.size(); n += 3) {
    BCCSKEL_RETURN_IF_ERROR(mesh_.AddVertex({values[n], values[n + 1], values[n + 2]}));
  }
  return absl::OkStatus();
}

absl::Status CellCollector::AddCell(FaceShape shape, const DataArray& corners, size_t begin,
                                    size_t end) {
  corners_.clear();
  for (size_t n = begin; n < end; ++n) {
    const double corner = corners[n];
    if (!(corner >= 0 && corner < static_cast<double>(points_)) || corner != std::floor(corner)) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "%s: a cell names point %.17g (counted from 0) of %d points", format_, corner, points_));
    }
    corners_.push_back(static_cast<int64_t>(first_) + static_cast<int64_t>(corner));
  }
  return shape == FaceShape::kStrip ? mesh_.AddStrip(corners_) : mesh_.AddPolygon(corners_);
}

absl::Status CellCollector::AddCells(FaceShape shape, const DataArray& ends,
                                     const DataArray& corners) {
  size_t begin = 0;
  for (size_t n = 0; n < ends.size(); ++n) {
    const double end = ends[n];
    if (!(end >= static_cast<double>(begin) && end <= static_cast<double>(corners.size()))) {
      return absl::InvalidArgumentError(
          absl::StrFormat("%s: offset %d is %.17g, not between the one before it, %d, and the "
                          "number of corners, %d",
                          format_, n, end, begin, corners.size()));
    }
    BCCSKEL_RETURN_IF_ERROR(AddCell(shape, corners, begin, static_cast<size_t>(end)));
    begin = static_cast<size_t>(end);
  }
  if (begin == corners.size()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("%s: the offsets end at %d of %d corners", format_, begin, corners.size()));
}

}  // namespace bccskel
