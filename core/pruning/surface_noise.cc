#include "core/pruning/surface_noise.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/certificate/brick_sum.h"
#include "core/distance/border_bricks.h"
#include "core/volume/brick.h"
#include "core/volume/brick_neighbors.h"

namespace bccskel {
namespace {

constexpr double kSmooth = 0.01, kRough = 0.025;  // roughness
constexpr double kLeastNoise = 1.5;               // lattice units
constexpr double kMostSteps = 3;
constexpr double kLeastStretch = 0.4;  // share of the stretch of the noise that the margin gets
constexpr double kRoughMargin = 10;    // the same, for each unit of roughness

constexpr uint64_t kFirstInRows = 0x0001'0001'0001'0001;
constexpr uint64_t kLastInRows = kFirstInRows << 15;
constexpr int kRow = 16, kLastRow = 48;  // bits

// The six bricks beside a brick: +x, -x, +y, -y, +z, -z.
using Beside = std::array<const BrickBits*, 6>;

// Which points of layer k have an object point beside them, for each direction.
std::array<uint64_t, 6> PlanesBeside(const BrickBits& own, const Beside& beside, size_t k) {
  const uint64_t word = own.words[k];
  const auto in = [&](size_t way) { return beside[way]->words[k]; };
  return {(word >> 1 & ~kLastInRows) | (in(0) & kFirstInRows) << 15,
          (word << 1 & ~kFirstInRows) | (in(1) & kLastInRows) >> 15,
          word >> kRow | in(2) << kLastRow,
          word << kRow | in(3) >> kLastRow,
          k + 1 < own.words.size() ? own.words[k + 1] : beside[4]->words.front(),
          k > 0 ? own.words[k - 1] : beside[5]->words.back()};
}

struct SurfaceCount {
  int64_t points = 0;
  int64_t pits = 0;

  void Add(uint64_t own, const std::array<uint64_t, 6>& p) {
    const uint64_t surface = own & ~(p[0] & p[1] & p[2] & p[3] & p[4] & p[5]);
    if (surface != 0) points += std::popcount(surface);
    const uint64_t ones_a = p[0] ^ p[1] ^ p[2], twos_a = (p[0] & p[1]) | (p[2] & (p[0] ^ p[1]));
    const uint64_t ones_b = p[3] ^ p[4] ^ p[5], twos_b = (p[3] & p[4]) | (p[5] & (p[3] ^ p[4]));
    const uint64_t four = (twos_a & twos_b) | ((twos_a ^ twos_b) & ones_a & ones_b);
    const uint64_t pit = four & ~own;
    if (pit != 0) pits += std::popcount(pit);
  }
};

SurfaceCount CountIn(const Volume& object, const exec::Share& share) {
  SurfaceCount count;
  const std::span<const BrickBits> bricks = object.padded_bricks();
  for (size_t n = share.begin; n < share.end; ++n) {
    Beside beside;
    for (size_t way = 0; way < 6; ++way) beside[way] = &bricks[object.neighbors()[n][8 + way]];
    const auto is_full = [](const BrickBits* brick) { return IsFull(*brick); };
    if (IsFull(bricks[n]) && std::ranges::all_of(beside, is_full)) continue;  // no surface
    for (size_t k = 0; k < bricks[n].words.size(); ++k) {
      count.Add(bricks[n].words[k], PlanesBeside(bricks[n], beside, k));
    }
  }
  return count;
}

}  // namespace

// Shape and noise are independent, so their squares add. The margin is for the thinnest limbs, for
// which this is less than the noise itself.
double SurfaceNoise::Beyond(double elongation, double radius, const Coordinates& way) const {
  const double stretch = Stretch(way);
  const double share = std::clamp(kRoughMargin * roughness, kLeastStretch, 1.0);
  const double margin = kMargin * (1 + share * (stretch - 1));
  const double noise = stretch * At(radius) + margin;
  if (elongation <= noise) return elongation - noise;
  return std::sqrt(elongation * elongation - noise * noise);
}

double Roughness(const Volume& object, const exec::Context& context) {
  std::atomic<int64_t> pits = 0;
  const int64_t points =
      SumOverBricks(context, object.brick_count(), [&](int, const exec::Share& bricks) {
        const SurfaceCount count = CountIn(object, bricks);
        pits += count.pits;
        return count.points;
      });
  return points == 0 ? 0 : static_cast<double>(pits) / static_cast<double>(points);
}

SurfaceNoise SurfaceNoiseOf(const Volume& object, double step, const std::array<int32_t, 3>& slabs,
                            const exec::Context& context) {
  const double rough =
      std::clamp((Roughness(object, context) - kSmooth) / (kRough - kSmooth), 0.0, 1.0);
  const double least = std::max(step, kLeastNoise);
  const double thin = least + (kMostSteps * step - least) * rough;
  AxisScale edges = AxisScaleOf(object.placement());
  for (size_t axis = 0; axis < 3; ++axis) edges[axis] *= slabs[axis];
  const double shortest = std::ranges::min(edges);
  for (double& edge : edges) edge /= shortest;
  return {step, rough, thin, step > 1 ? least : thin, edges};
}

}  // namespace bccskel
