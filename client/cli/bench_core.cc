#include "client/cli/bench_core.h"

#include <algorithm>

#include "client/cli/bench_memory.h"
#include "client/cli/bench_objects.h"
#include "core/exec/status_macros.h"
#include "core/import/shapes/shapes.h"

namespace bccskel::cli {
namespace {

absl::Status LoadCode(const SkeletonizeOptions& options, const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(const Volume ball, MakeBenchObject("ball", kMinShapePoints));
  return Skeletonize(ball, options, context).status();
}

uint64_t BytesOf(const Volume& volume) {
  return volume.keys().size_bytes() + volume.padded_bricks().size_bytes();
}

absl::Status RunCold(const Volume& object, const SkeletonizeOptions& options,
                     const exec::Context& context, CoreMeasurement& into) {
  const PeakGrowth growth;
  BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result, Skeletonize(object, options, context));
  into.peak_bytes = growth.bytes();
  if (into.peak_bytes.has_value()) *into.peak_bytes += BytesOf(object);
  into.cold = result.timings;
  into.points = result.object_points;
  into.sha256 = result.sha256;
  return absl::OkStatus();
}

}  // namespace

Spread SpreadOf(std::vector<double> values) {
  std::ranges::sort(values);
  const size_t n = values.size();
  return {values.front(), (values[(n - 1) / 2] + values[n / 2]) / 2, values.back()};
}

absl::StatusOr<CoreMeasurement> MeasureCore(const Volume& object, const SkeletonizeOptions& options,
                                            int repeat, const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(LoadCode(options, context));
  CoreMeasurement measured;
  measured.bricks = object.brick_count();
  BCCSKEL_RETURN_IF_ERROR(RunCold(object, options, context, measured));
  for (int n = 0; n < repeat; ++n) {
    BCCSKEL_ASSIGN_OR_RETURN(const SkeletonizeResult result, Skeletonize(object, options, context));
    if (result.sha256 != measured.sha256) {
      return absl::InternalError("two runs gave different skeletons: " + measured.sha256 + " and " +
                                 result.sha256);
    }
    measured.warm.push_back(result.timings);
  }
  return measured;
}

}  // namespace bccskel::cli
