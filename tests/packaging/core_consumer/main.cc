// A program outside the repository: skeletonizes a ring with the installed core library.
#include <cmath>
#include <cstdio>
#include <string>

#include "core/pipeline/skeletonize.h"
#include "core/version/version.h"
#include "core/volume/volume.h"

namespace {

constexpr int kCells = 24;

bccskel::Volume Ring() {
  bccskel::VolumeBuilder builder({kCells, kCells, kCells});
  const double center = kCells, ring_radius = 14, tube_radius = 5;
  for (int z = 0; z < 2 * kCells; ++z) {
    for (int y = z % 2; y < 2 * kCells; y += 2) {
      for (int x = z % 2; x < 2 * kCells; x += 2) {
        const double off_ring = std::hypot(x - center, y - center) - ring_radius;
        if (std::hypot(off_ring, z - center) < tube_radius) builder.Add({x, y, z});
      }
    }
  }
  return std::move(builder).Build().value();
}

}  // namespace

int main() {
  const auto result = bccskel::Skeletonize(Ring(), {}, bccskel::exec::Context());
  if (!result.ok()) {
    std::fprintf(stderr, "%s\n", std::string(result.status().message()).c_str());
    return 1;
  }
  const auto& skeleton = result->certificate.skeleton;
  std::printf("bccskel %s: components %lld, loops %lld, sha256 %s\n",
              std::string(bccskel::Version()).c_str(), static_cast<long long>(skeleton.components),
              static_cast<long long>(skeleton.loops), result->sha256.c_str());
}
