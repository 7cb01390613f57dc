#include <array>
#include <bit>

#include "core/certificate/brick_sum.h"
#include "core/certificate/certificate.h"
#include "core/certificate/neighbor_planes.h"
#include "core/topology/neighborhood.h"
#include "core/volume/brick_neighbors.h"

namespace bccskel {
namespace {

using NeighborPlanes = std::array<BrickBits, kNeighborCount>;

// Points that may satisfy Conditions 1 and 2. More than one neighbor in one component means that
// two neighbors are adjacent to each other; one background component, that one is missing.
uint64_t CandidatesInWord(const BrickBits& points, const NeighborPlanes& planes, size_t k) {
  uint64_t adjacent_pair = 0, all = ~uint64_t{0};
  for (size_t a = 0; a < kNeighborCount; ++a) {
    uint64_t adjacent = 0;
    for (size_t b = 0; b < a; ++b) {
      if (((kSharedNeighbors[a] >> b) & 1) != 0) adjacent |= planes[b].words[k];
    }
    adjacent_pair |= adjacent & planes[a].words[k];
    all &= planes[a].words[k];
  }
  return points.words[k] & adjacent_pair & ~all;
}

NeighborMask MaskOf(const NeighborPlanes& planes, size_t k, int bit) {
  unsigned mask = 0;
  for (size_t d = 0; d < kNeighborCount; ++d) {
    mask |= static_cast<unsigned>((planes[d].words[k] >> bit) & 1) << d;
  }
  return static_cast<NeighborMask>(mask);
}

int64_t CountInBrick(const BrickBits& points, const NeighborPlanes& planes) {
  int64_t count = 0;
  for (size_t k = 0; k < 8; ++k) {
    for (uint64_t rest = CandidatesInWord(points, planes, k); rest != 0; rest &= rest - 1) {
      count += IsSimpleNonEnd(MaskOf(planes, k, std::countr_zero(rest))) ? 1 : 0;
    }
  }
  return count;
}

}  // namespace

uint64_t CountSimpleNonEndPoints(const Volume& object, const exec::Context& context) {
  const std::vector<BrickNeighborhood> neighbors = FindBrickNeighbors(object.keys());
  const std::span<const BrickBits> bricks = object.padded_bricks();
  return static_cast<uint64_t>(
      SumOverBricks(context, object.brick_count(), [&](int, size_t n) -> int64_t {
        NeighborPlanes planes;
        for (int d = 0; d < kNeighborCount; ++d) {
          planes[static_cast<size_t>(d)] =
              NeighborPlane(Direction(d), object.keys()[n].coordinates().sublattice, bricks[n],
                            [&](int position) -> const BrickBits& {
                              return bricks[neighbors[n][static_cast<size_t>(position)]];
                            });
        }
        return CountInBrick(bricks[n], planes);
      }));
}

}  // namespace bccskel
