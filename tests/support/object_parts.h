#ifndef BCCSKEL_TESTS_SUPPORT_OBJECT_PARTS_H_
#define BCCSKEL_TESTS_SUPPORT_OBJECT_PARTS_H_

#include <utility>
#include <vector>

#include "core/volume/layer_part.h"
#include "core/volume/volume.h"

namespace bccskel::test {

// The bricks of the part's layers.
inline Volume OnlyLayers(const Volume& object, const LayerPart& part) {
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bricks;
  for (size_t n = 0; n < object.brick_count(); ++n) {
    if (!part.Has(object.keys()[n].coordinates().bz)) continue;
    keys.push_back(object.keys()[n]);
    bricks.push_back(object.bricks()[n]);
  }
  return Volume::FromSortedBricks(object.extent(), object.placement(), std::move(keys),
                                  std::move(bricks));
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_OBJECT_PARTS_H_
