#include <cstdio>
#include <cstdlib>

#include "client/cli/bench_core.h"
#include "tests/support/even_points.h"

// Writes a bench object on the cubic grid, for tools that know no other: first a line
// "NX NY NZ VOXELS", then a bit per voxel, x fastest, lowest bit first.
// Half of an object's points lie on that grid, so it is made with twice the wanted number.
// Usage: bccskel_cubic_object OBJECT VOXELS

namespace bccskel {
namespace {

int Write(const char* name, uint64_t wanted) {
  const auto object = cli::MakeBenchObject(name, 2 * wanted);
  if (!object.ok()) {
    std::fprintf(stderr, "%s\n", object.status().ToString().c_str());
    return 1;
  }
  const test::Voxels voxels = test::EvenPoints(*object);
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
