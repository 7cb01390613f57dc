#include "tests/support/even_points.h"

namespace bccskel::test {
namespace {

bool IsEven(LatticePoint p) { return ((p.x | p.y | p.z) & 1) == 0; }

}  // namespace

Voxels EvenPoints(const Volume& object) {
  const LatticeExtent& extent = object.extent();
  const auto nx = static_cast<size_t>(extent.nx), ny = static_cast<size_t>(extent.ny);
  Voxels voxels{std::vector<uint8_t>((nx * ny * static_cast<size_t>(extent.nz) + 7) / 8)};
  object.ForEachPoint([&](LatticePoint p) {
    if (!IsEven(p)) return;
    const auto x = static_cast<size_t>(p.x / 2), y = static_cast<size_t>(p.y / 2);
    const size_t n = (static_cast<size_t>(p.z / 2) * ny + y) * nx + x;
    voxels.bits[n / 8] = static_cast<uint8_t>(voxels.bits[n / 8] | 1u << n % 8);
    ++voxels.count;
  });
  return voxels;
}

}  // namespace bccskel::test
