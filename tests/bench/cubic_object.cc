#include <cstdio>
#include <cstdlib>
#include <vector>

#include "client/cli/bench_objects.h"

// Writes a bench object on the cubic grid, for tools that know no other: first a line
// "NX NY NZ VOXELS", then a bit per voxel, x fastest, lowest bit first.
// The lattice points whose coordinates are all even form a cubic grid and are half of all, so the
// object is made with twice the wanted number of points.
// Usage: bccskel_cubic_object OBJECT VOXELS

namespace bccskel {
namespace {

bool IsEven(LatticePoint p) { return ((p.x | p.y | p.z) & 1) == 0; }

struct Voxels {
  std::vector<uint8_t> bits;
  uint64_t count = 0;
};

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

int Write(const char* name, uint64_t wanted) {
  const auto object = cli::MakeBenchObject(name, 2 * wanted);
  if (!object.ok()) {
    std::fprintf(stderr, "%s\n", object.status().ToString().c_str());
    return 1;
  }
  const Voxels voxels = EvenPoints(*object);
  const LatticeExtent& extent = object->extent();
  std::printf("%d %d %d %llu\n", extent.nx, extent.ny, extent.nz,
              static_cast<unsigned long long>(voxels.count));
  const size_t written = std::fwrite(voxels.bits.data(), 1, voxels.bits.size(), stdout);
  return written == voxels.bits.size() && std::fflush(stdout) == 0 ? 0 : 1;
}

}  // namespace
}  // namespace bccskel

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s OBJECT VOXELS\n", argv[0]);
    return 2;
  }
  return bccskel::Write(argv[1], std::strtoull(argv[2], nullptr, 10));
}
