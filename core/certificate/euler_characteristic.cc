// Does: counts points - edges + triangles - tetrahedra of the clique complex, 512 points at a time.
//
// Why it is right: put the points in one by one in the order of f(p) = x + y + z. No two neighbors
// have equal f. Point p then adds 1 - chi(L), where L is the part of its link already there: the
// object points among its seven neighbors with smaller f (all cliques that p completes, counted
// where they are completed, so each clique is counted once). The seven form a wheel:
//
//          (-2,0,0)---(-1,-1,1)
//            /     \ /     \                the hub h = (-1,-1,-1) is a neighbor of all six of the
//     (-1,1,-1)-----h-----(0,-2,0)          rim, the rim is a closed hexagon
//            \     / \     /
//          (0,0,-2)---(1,-1,-1)
//
// With the hub in the object L is a cone over it and chi(L) = 1: p adds nothing. Without the hub L
// is a part of the hexagon, and its points less its edges are as many as its arcs (none for the
// full rim). So
//     chi = sum over points p with p + h in the background of (1 - arcs of the rim in the object),
// and only points at one side of the object's border count.
//
// Cost: seven neighbor planes per brick, about 25 logic operations and 3 bit counts per word.
#include "core/certificate/euler_characteristic.h"

#include <array>
#include <bit>

#include "core/certificate/brick_sum.h"
#include "core/certificate/certificate.h"
#include "core/certificate/neighbor_planes.h"
#include "core/volume/brick_neighbors.h"

namespace bccskel {
namespace {

constexpr LatticePoint kHub = {-1, -1, -1};
constexpr std::array<LatticePoint, 6> kRim = {
    {{-2, 0, 0}, {-1, -1, 1}, {0, -2, 0}, {1, -1, -1}, {0, 0, -2}, {-1, 1, -1}}};

constexpr bool IsWheel() {
  for (size_t n = 0; n < 6; ++n) {
    if (!FindDirection(kRim[n]) || !FindDirection(kRim[n] - kHub)) return false;
    for (size_t m = 0; m < n; ++m) {
      const bool next = n - m == 1 || n - m == 5;
      if (FindDirection(kRim[n] - kRim[m]).has_value() != next) return false;
    }
  }
  return true;
}
static_assert(IsWheel());

// Points that count, and the number of arcs at each as two binary digits.
struct WheelWord {
  uint64_t counted;
  uint64_t ones;
  uint64_t twos;
};

// An arc ends where a rim point is in the object and the next one is not. There are at most three,
// so the carries of the two full adders and of their sum exclude each other.
WheelWord CountArcs(uint64_t points, uint64_t hub, const std::array<uint64_t, 6>& rim) {
  const uint64_t a = rim[0] & ~rim[1], b = rim[1] & ~rim[2], c = rim[2] & ~rim[3];
  const uint64_t d = rim[3] & ~rim[4], e = rim[4] & ~rim[5], f = rim[5] & ~rim[0];
  const uint64_t abc = a ^ b ^ c, def = d ^ e ^ f;
  const uint64_t twos = (a & b) | (c & (a ^ b)) | (d & e) | (f & (d ^ e)) | (abc & def);
  const uint64_t counted = points & ~hub;
  return {counted, counted & (abc ^ def), counted & twos};
}

int64_t WheelSum(const BrickBits& points, const BrickBits& hub,
                 const std::array<BrickBits, 6>& rim) {
  int64_t sum = 0;
  for (size_t k = 0; k < 8; ++k) {
    if ((points.words[k] & ~hub.words[k]) == 0) continue;
    const WheelWord word = CountArcs(points.words[k], hub.words[k],
                                     {rim[0].words[k], rim[1].words[k], rim[2].words[k],
                                      rim[3].words[k], rim[4].words[k], rim[5].words[k]});
    sum += std::popcount(word.counted) - std::popcount(word.ones) - 2 * std::popcount(word.twos);
  }
  return sum;
}

bool AllCovered(const BrickBits& points, const BrickBits& cover) {
  uint64_t left = 0;
  for (size_t k = 0; k < 8; ++k) left |= points.words[k] & ~cover.words[k];
  return left == 0;
}

}  // namespace

int64_t CountEulerCharacteristic(const Volume& object, std::span<const BrickNeighborhood> neighbors,
                                 const exec::Context& context) {
  const std::span<const BrickBits> bricks = object.padded_bricks();
  return SumOverBricks(context, object.brick_count(), [&](int, size_t n) -> int64_t {
    const auto plane = [&](LatticePoint offset) {
      return NeighborPlane(*FindDirection(offset), object.keys()[n].coordinates().sublattice,
                           bricks[n], [&](int position) -> const BrickBits& {
                             return bricks[neighbors[n][static_cast<size_t>(position)]];
                           });
    };
    const BrickBits hub = plane(kHub);
    if (AllCovered(bricks[n], hub)) return 0;
    return WheelSum(bricks[n], hub,
                    {plane(kRim[0]), plane(kRim[1]), plane(kRim[2]), plane(kRim[3]), plane(kRim[4]),
                     plane(kRim[5])});
  });
}

int64_t CountEulerCharacteristic(const Volume& object, const exec::Context& context) {
  return CountEulerCharacteristic(object, FindBrickNeighbors(object.keys()), context);
}

}  // namespace bccskel
