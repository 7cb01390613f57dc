#ifndef BCCSKEL_CORE_VOLUME_LAYER_PART_H_
#define BCCSKEL_CORE_VOLUME_LAYER_PART_H_

#include <cstdint>
#include <utility>
#include <vector>

#include "core/volume/volume.h"

namespace bccskel {

// Every count-th layer of bricks, from layer `index` on: what one of several readers takes of an
// object. Layers in turn give all of them about as much, wherever in its box the object lies.
// Needs: 0 <= index < count.
struct LayerPart {
  int32_t index = 0;
  int32_t count = 1;

  constexpr bool Has(int32_t bz) const { return bz % count == index; }
  // Or a layer beside one that it has.
  constexpr bool IsNear(int32_t bz) const { return Has(bz - 1) || Has(bz) || Has(bz + 1); }
};

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

}  // namespace bccskel

#endif  // BCCSKEL_CORE_VOLUME_LAYER_PART_H_
