#ifndef BCCSKEL_CORE_RANKS_LAYER_OWNERS_H_
#define BCCSKEL_CORE_RANKS_LAYER_OWNERS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/exec/worker_team.h"
#include "core/ranks/exchange.h"
#include "core/ranks/packing.h"
#include "core/volume/volume.h"

namespace bccskel::ranks {

// Packs a brick into 72 bytes.
void PackBrick(BrickKey key, const BrickBits& bits, Bytes& to);
void TakeBrick(Unpacker& from, std::vector<BrickKey>& keys, std::vector<BrickBits>& bits);

// Assigns layers of bricks to the ranks that measure them: runs of layers with roughly equal
// numbers of bricks.
class LayerOwners {
 public:
  // `own` of the bricks of `local`.
  LayerOwners(Exchange& exchange, const Volume& local, exec::Share own);

  // Layers of the box.
  int32_t count() const { return static_cast<int32_t>(ranks_.size()); }
  // The rank of a layer; outside the box, that of the nearest layer.
  size_t RankOf(int32_t layer) const;
  // The layers of a rank.
  int32_t FirstOf(int rank) const;
  int32_t EndOf(int rank) const { return FirstOf(rank + 1); }

 private:
  std::vector<uint64_t> ranks_;
};

// The bricks in layers [first, end).
exec::Share BricksOfLayers(const Volume& volume, int32_t first, int32_t end);

// Returns the bricks of this rank's layers and those of the layers below and above.
Volume MoveToLayers(Exchange& exchange, const LayerOwners& layers, const Volume& local,
                    exec::Share own);

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_LAYER_OWNERS_H_
