#ifndef BCCSKEL_TESTS_CORE_TOPOLOGY_MASK_SYMMETRIES_H_
#define BCCSKEL_TESTS_CORE_TOPOLOGY_MASK_SYMMETRIES_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/lattice/directions.h"

namespace bccskel::test {

// Where a symmetry of the cube takes each of the 14 neighbors.
using NeighborPermutation = std::array<int, kNeighborCount>;

// All permutations of the axes combined with all reflections.
inline std::vector<NeighborPermutation> CubeSymmetries() {
  std::vector<NeighborPermutation> symmetries;
  std::array<size_t, 3> axes = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      NeighborPermutation to = {};
      for (int bit = 0; bit < kNeighborCount; ++bit) {
        const LatticePoint p = Direction(bit).offset();
        std::array<int, 3> c = {p.x, p.y, p.z}, image = {};
        for (size_t n = 0; n < 3; ++n) image[n] = (signs >> n & 1) != 0 ? -c[axes[n]] : c[axes[n]];
        to[static_cast<size_t>(bit)] = FindDirection({image[0], image[1], image[2]})->bit();
      }
      symmetries.push_back(to);
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return symmetries;
}

inline NeighborMask Permuted(NeighborMask mask, const NeighborPermutation& to) {
  unsigned image = 0;
  for (size_t bit = 0; bit < kNeighborCount; ++bit) image |= (mask >> bit & 1u) << to[bit];
  return static_cast<NeighborMask>(image);
}

inline NeighborMask LeastImage(NeighborMask mask, std::span<const NeighborPermutation> symmetries) {
  NeighborMask least = mask;
  for (const NeighborPermutation& symmetry : symmetries) {
    least = std::min(least, Permuted(mask, symmetry));
  }
  return least;
}

inline uint64_t Fnv1a64(std::span<const uint8_t> bytes) {
  uint64_t hash = 0xcbf29ce484222325;
  for (uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3;
  return hash;
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_TOPOLOGY_MASK_SYMMETRIES_H_
