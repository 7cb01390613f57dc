#ifndef BCCSKEL_CLIENT_CLI_BENCH_CORE_H_
#define BCCSKEL_CLIENT_CLI_BENCH_CORE_H_

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/pipeline/skeletonize.h"
#include "core/volume/volume.h"

// Measures the engine: a volume in memory becomes a skeleton in memory, without files or a server.

// The objects that benchmarks measure, here and in tests/bench: shapes of core/import/shapes,
// except that
//   blob        has 2 % of its boundary flipped, as scanned objects have;
//   thin-tubes  is the tubes twelve times as long, about 0.01 % of their box.

namespace bccskel::cli {

using Milliseconds = std::chrono::duration<double, std::milli>;

// The time from the solid to thin points; the total includes the certificate and the graph.
inline Milliseconds CoreTime(const StageTimings& timings) {
  return timings.distance + timings.shells + timings.thinning + timings.cleanup;
}

struct Spread {
  double min = 0;
  double median = 0;  // of an even number of values, the mean of the middle two
  double max = 0;
};
Spread SpreadOf(std::vector<double> values);  // Needs: at least one value.

struct CoreMeasurement {
  uint64_t points = 0;
  size_t bricks = 0;
  StageTimings cold;               // first run, on memory new to the process
  std::vector<StageTimings> warm;  // the later runs
  // Of the cold run: the object, everything computed from it, and the result.
  std::optional<uint64_t> peak_bytes;
  std::string sha256;  // of the skeleton
};

// The paper's distances for its method, unless others are given.
inline DistanceKind DistanceFor(ThinningMethod method, std::optional<DistanceKind> given) {
  const bool symmetric = method == ThinningMethod::kSymmetric;
  return given.value_or(symmetric ? DistanceKind::kEuclidean : DistanceKind::kChamfer);
}

// One cold run and `repeat` warm ones. Thins a tiny object first, so that the cold run does not
// load the program's code.
// Needs:  repeat >= 1.
// Errors: as Skeletonize(); INTERNAL if two runs gave different skeletons.
absl::StatusOr<CoreMeasurement> MeasureCore(const Volume& object, const SkeletonizeOptions& options,
                                            int repeat, const exec::Context& context);

// The peak growth of this process's resident memory since construction. The constructor first
// returns freed memory to the system, so that its reuse counts. Linux only: VmRSS and VmHWM,
// accurate to about 0.5 MB.
class PeakGrowth {
 public:
  PeakGrowth();

  // Empty if the system does not let a process reset its high-water mark.
  std::optional<uint64_t> bytes() const;

 private:
  std::optional<uint64_t> before_;
};

inline constexpr std::array<const char*, 7> kBenchObjects = {"ball",  "torus", "horse",     "blob",
                                                             "tubes", "tree",  "thin-tubes"};

// The same points on every machine.
// Errors: INVALID_ARGUMENT for a name that is not in kBenchObjects, and as GenerateShape().
absl::StatusOr<Volume> MakeBenchObject(std::string_view name, uint64_t points);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_BENCH_CORE_H_
