#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <span>

#include "client/cli/bench_core.h"
#include "core/exec/worker_team.h"
#include "core/import/shapes/rasterize.h"
#include "core/import/shapes/solids.h"

// Makes a skeleton of a ball that fills a share of a lattice of N^3 cells, once, and says as JSON
// what that took. With 2048 and 0.45 that is an object of 7.7e9 points.
// Usage: bccskel_large_lattice CELLS SHARE THREADS

namespace bccskel {
namespace {

absl::StatusOr<Volume> BallInLattice(double cells, double share) {
  const double units = 2 * cells;
  const double radius = units * std::cbrt(share * 3 / (4 * std::numbers::pi));
  const shapes::Solid ball = shapes::BallShell{.outer_radius = radius, .inner_radius = 0};
  return shapes::Rasterize(std::span(&ball, 1), 1);
}

void Tell(const exec::ShellProgress& progress) {
  if (progress.shell % 100 != 0) return;
  std::fprintf(stderr, "shell %d of %d\n", progress.shell, progress.last_shell);
}

void Print(const Volume& object, uint64_t peak_bytes, const SkeletonizeResult& result) {
  const auto points = static_cast<double>(result.object_points);
  const double lattice_points = static_cast<double>(object.brick_count()) * kBrickPoints;
  std::printf("{\"points\":%.0f,\"lattice_points\":%.0f,\"skeleton_points\":%llu,\"last_shell\":%d",
              points, lattice_points, static_cast<unsigned long long>(result.skeleton_points),
              result.last_shell);
  for (const Stage& stage : kStages) {
    const std::chrono::duration<double> time = result.timings.*stage.time;
    std::printf(",\"%s_s\":%.2f", stage.name, time.count());
  }
  const double total = 1e6 * cli::WholeTime(result.timings).count();
  std::printf(
      ",\"whole_ns_per_point\":%.2f,\"peak_bytes\":%llu,\"bytes_per_lattice_point\":%.2f}\n",
      total / points, static_cast<unsigned long long>(peak_bytes),
      static_cast<double>(peak_bytes) / lattice_points);
}

int Run(double cells, double share, int threads) {
  const absl::StatusOr<Volume> object = BallInLattice(cells, share);
  if (!object.ok()) {
    std::fprintf(stderr, "%s\n", object.status().ToString().c_str());
    return 1;
  }
  exec::WorkerTeam team(threads);
  exec::Context context;
  context.team = &team;
  context.on_shell = Tell;
  const cli::PeakGrowth growth;
  const uint64_t own = object->keys().size_bytes() + object->padded_bricks().size_bytes();
  const auto result = Skeletonize(
      *object,
      {.thinning = {.method = ThinningMethod::kDirectional}, .distance = DistanceKind::kChamfer},
      context);
  if (!result.ok()) {
    std::fprintf(stderr, "%s\n", result.status().ToString().c_str());
    return 1;
  }
  Print(*object, growth.bytes().value_or(0) + own, *result);
  return 0;
}

}  // namespace
}  // namespace bccskel

int main(int argc, char** argv) {
  const double cells = argc == 4 ? std::atof(argv[1]) : 0;
  const double share = argc == 4 ? std::atof(argv[2]) : 0;
  const int threads = argc == 4 ? std::atoi(argv[3]) : 0;
  if (!(cells >= 1 && share > 0 && share <= 0.5 && threads >= 1)) {
    std::fprintf(stderr, "usage: %s CELLS SHARE THREADS (a ball fills 0 to 0.5 of its cube)\n",
                 argv[0]);
    return 2;
  }
  return bccskel::Run(cells, share, threads);
}
