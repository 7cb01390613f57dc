#include "core/pruning/sheet_set.h"

namespace bccskel {

SheetSet::SheetSet(const ThinPoints& points)
    : points_(points), masks_(points.size()), left_(points.size(), 1) {
  for (PointIndex p = 0; p < points.size(); ++p) masks_[p] = points.mask(p);
}

void SheetSet::Remove(PointIndex p) {
  TakeOut(p, points_, masks_);
  left_[p] = 0;
}

std::vector<PointIndex> SheetSet::Points() const {
  std::vector<PointIndex> points;
  for (PointIndex p = 0; p < left_.size(); ++p) {
    if (Contains(p)) points.push_back(p);
  }
  return points;
}

}  // namespace bccskel
