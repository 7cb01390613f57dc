#ifndef BCCSKEL_TESTS_CORE_IO_TEST_VOLUMES_H_
#define BCCSKEL_TESTS_CORE_IO_TEST_VOLUMES_H_

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/volume/volume.h"
#include "tests/support/volume_where.h"

namespace bccskel {

inline Placement SkewedPlacement() {
  return {.spacing = {0.5, 0.25, 2.0},
          .origin = {-1.5, 0.0, 1e-3},
          .direction = {0, 1, 0, -1, 0, 0, 0, 0, 1}};
}

// Random points in clumps, so that there are empty, sparse and full bricks.
inline Volume RandomVolume(LatticeExtent extent, uint64_t seed,
                           const Placement& placement = SkewedPlacement()) {
  std::mt19937_64 random(seed);
  VolumeBuilder builder(extent, placement);
  const auto below = [&](int32_t n) { return static_cast<int32_t>(random() % uint64_t(n)); };
  for (int clump = 0; clump < 12; ++clump) {
    const int32_t i = below(extent.nx), j = below(extent.ny), k = below(extent.nz);
    const int32_t edge = 1 + below(20), keep = 1 + below(8);
    for (Sublattice sublattice : kSublattices) {
      for (int32_t n = 0; n < edge * edge * edge; ++n) {
        if (below(8) >= keep) continue;
        builder.Add(PointAt(sublattice, i + n % edge, j + n / edge % edge, k + n / edge / edge));
      }
    }
  }
  return *std::move(builder).Build();
}

inline Volume EmptyVolume(LatticeExtent extent) {
  return *VolumeBuilder(extent, SkewedPlacement()).Build();
}

inline Volume FullVolume(LatticeExtent extent) {
  return test::FullVolume(extent, SkewedPlacement());
}

inline Volume CornerVolume(LatticeExtent extent) {
  VolumeBuilder builder(extent, SkewedPlacement());
  builder.Add(PointAt(Sublattice::kEven, 0, 0, 0));
  builder.Add(PointAt(Sublattice::kOdd, extent.nx - 1, extent.ny - 1, extent.nz - 1));
  return *std::move(builder).Build();
}

// The shapes that go wrong first: one cell, edges on and off the brick and word sizes, nothing,
// everything.
inline std::vector<Volume> EdgeVolumes() {
  std::vector<Volume> volumes = {
      EmptyVolume({1, 1, 1}),    FullVolume({1, 1, 1}),     EmptyVolume({33, 9, 70}),
      CornerVolume({17, 5, 33}), CornerVolume({16, 4, 32}), CornerVolume({15, 3, 31}),
      FullVolume({18, 6, 40}),   FullVolume({16, 4, 8}),    FullVolume({3, 2, 64}),
      CornerVolume({200, 1, 1}), CornerVolume({1, 200, 1}), CornerVolume({1, 1, 200}),
  };
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    std::mt19937_64 random(seed);
    const auto edge = [&] { return 1 + static_cast<int32_t>(random() % 90); };
    const int32_t nx = edge(), ny = edge(), nz = edge();
    volumes.push_back(RandomVolume({nx, ny, nz}, seed));
  }
  return volumes;
}

inline std::span<const std::byte> BytesOf(const std::string& text) {
  return std::as_bytes(std::span(text));
}

}  // namespace bccskel

#endif  // BCCSKEL_TESTS_CORE_IO_TEST_VOLUMES_H_
