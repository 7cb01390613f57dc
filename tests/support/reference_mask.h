#ifndef BCCSKEL_TESTS_SUPPORT_REFERENCE_MASK_H_
#define BCCSKEL_TESTS_SUPPORT_REFERENCE_MASK_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/certificate/certificate.h"
#include "core/lattice/lattice_point.h"

namespace bccskel::test {

// A cubic mask as one byte a voxel, x fastest. Slow and plain on purpose: the oracle of core/mask.
struct ReferenceMask {
  int32_t nx = 0;
  int32_t ny = 0;
  int32_t nz = 0;
  std::vector<uint8_t> voxels;

  size_t Index(int32_t x, int32_t y, int32_t z) const {
    return static_cast<size_t>(x) +
           static_cast<size_t>(nx) *
               (static_cast<size_t>(y) + static_cast<size_t>(ny) * static_cast<size_t>(z));
  }
  // False outside the grid.
  bool Contains(int32_t x, int32_t y, int32_t z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz && voxels[Index(x, y, z)] != 0;
  }
};

// The voxels for which `is_in(x, y, z)` holds; asks in the order of the voxels.
template <typename IsIn>
ReferenceMask MaskWhere(int32_t nx, int32_t ny, int32_t nz, const IsIn& is_in) {
  ReferenceMask mask{nx, ny, nz, {}};
  for (int32_t z = 0; z < nz; ++z) {
    for (int32_t y = 0; y < ny; ++y) {
      for (int32_t x = 0; x < nx; ++x) mask.voxels.push_back(is_in(x, y, z) ? 1 : 0);
    }
  }
  return mask;
}

// Voxel n is set when bit n of `bits` is. Needs: at most 64 voxels.
ReferenceMask MaskOfBits(int32_t nx, int32_t ny, int32_t nz, uint64_t bits);
// Each voxel with probability `density`; the same for the same seed on every machine.
ReferenceMask RandomMask(uint64_t seed, int32_t nx, int32_t ny, int32_t nz, double density);
// The union of seeded balls, cut off at the border.
ReferenceMask RandomBallMask(uint64_t seed, int32_t nx, int32_t ny, int32_t nz, int balls,
                             double largest_radius);

enum class ObjectReach : uint8_t { kCorner26, kFace6 };

// Components and cavities by flood fill, the background in a padded box; loops from the Euler
// characteristic, counted cell by cell: of the closed cubical complex for (26, 6), of the open one
// for (6, 26).
BettiNumbers ReferenceMaskBetti(const ReferenceMask& mask, ObjectReach reach);

// The points of the exact conversion, two a voxel, by the words of its definition.
std::vector<LatticePoint> ReferenceExactPoints(const ReferenceMask& mask, ObjectReach reach);

// Every voxel as 2 x 2 x 2.
ReferenceMask Refined(const ReferenceMask& mask);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_REFERENCE_MASK_H_
