#ifndef BCCSKEL_CORE_VOLUME_LAYER_PART_H_
#define BCCSKEL_CORE_VOLUME_LAYER_PART_H_

#include <cstdint>
#include <utility>
#include <vector>

#include "core/volume/volume.h"

namespace bccskel {

// Every count-th layer of bricks, starting with layer `index`: the part of an object that one of
// several readers takes. Interleaved layers give every reader about the same amount, wherever the
// object lies in its box.
// Needs: 0 <= index < count.
struct LayerPart {
  int32_t index = 0;
  int32_t count = 1;

  constexpr bool Has(int32_t bz) const { return bz % count == index; }
  // Whether the part has this layer or one beside it.
  constexpr bool IsNear(int32_t bz) const { return Has(bz - 1) || Has(bz) || Has(bz + 1); }
};

// Returns the object with only the bricks of the part's layers.
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

}  // namespace bccskel

#endif  // BCCSKEL_CORE_VOLUME_LAYER_PART_H_
