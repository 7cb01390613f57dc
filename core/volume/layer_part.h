#ifndef BCCSKEL_CORE_VOLUME_LAYER_PART_H_
#define BCCSKEL_CORE_VOLUME_LAYER_PART_H_

#include <cstdint>

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

}  // namespace bccskel

#endif  // BCCSKEL_CORE_VOLUME_LAYER_PART_H_
