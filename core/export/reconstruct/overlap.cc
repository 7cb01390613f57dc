#include "core/export/reconstruct/overlap.h"

namespace bccskel {

Overlap MeasureOverlap(const Volume& a, const Volume& b) {
  Overlap overlap;
  size_t at = 0;
  for (size_t n = 0; n < a.brick_count(); ++n) {
    while (at < b.brick_count() && b.keys()[at] < a.keys()[n]) ++at;
    if (at == b.brick_count() || b.keys()[at] != a.keys()[n]) continue;
    overlap.common += (a.bricks()[n] & b.bricks()[at]).Count();
  }
  overlap.all = a.PointCount() + b.PointCount() - overlap.common;
  return overlap;
}

}  // namespace bccskel
