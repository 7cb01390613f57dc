#include "core/export/reconstruct/overlap.h"

namespace bccskel {

Overlap MeasureOverlap(const Volume& a, const Volume& b) {
  Overlap overlap;
  size_t at = 0;
  for (size_t n = 0; n < a.brick_count(); ++n) {
    while (at < b.brick_count() && b.keys()[at] < a.keys()[n]) ++at;
    if (at == b.brick_count() || b.keys()[at] != a.keys()[n]) continue;
    BrickBits common = a.bricks()[n];
    for (size_t word = 0; word < common.words.size(); ++word) {
      common.words[word] &= b.bricks()[at].words[word];
    }
    overlap.common += common.Count();
  }
  overlap.all = a.PointCount() + b.PointCount() - overlap.common;
  return overlap;
}

}  // namespace bccskel
