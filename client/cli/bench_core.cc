#include "client/cli/bench_core.h"

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "absl/strings/str_join.h"
#include "core/exec/status_macros.h"
#include "core/import/shapes/branching.h"
#include "core/import/shapes/figures.h"
#include "core/import/shapes/shapes.h"

namespace bccskel::cli {
namespace {

// A line "VmRSS:   1234 kB" of /proc/self/status, in bytes.
std::optional<uint64_t> ProcessBytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    uint64_t kilobytes = 0;
    if (word == key && status >> kilobytes) return kilobytes * 1024;
  }
  return std::nullopt;
}

bool ResetHighWaterMark() {
  std::ofstream references("/proc/self/clear_refs");
  references << "5" << std::flush;  // see proc(5)
  return references.good();
}

}  // namespace

PeakGrowth::PeakGrowth() {
  malloc_trim(0);
  if (ResetHighWaterMark()) before_ = ProcessBytes("VmRSS:");
}

std::optional<uint64_t> PeakGrowth::bytes() const {
  const std::optional<uint64_t> peak = ProcessBytes("VmHWM:");
  if (!before_.has_value() || !peak.has_value()) return std::nullopt;
  return *peak > *before_ ? *peak - *before_ : 0;
}

namespace {

constexpr double kBlobNoise = 0.02;
constexpr shapes::BranchingPlan kThinTubes = {
    .levels = 3, .trunk_length = 67, .length_ratio = 0.9, .radius_ratio = 0.85};

}  // namespace

absl::StatusOr<Volume> MakeBenchObject(std::string_view name, uint64_t points) {
  if (std::ranges::find(kBenchObjects, name) == kBenchObjects.end()) {
    return absl::InvalidArgumentError("no bench object is named \"" +
                                      std::string(name.substr(0, 100)) + "\": must be one of " +
                                      absl::StrJoin(kBenchObjects, ", "));
  }
  if (name == "thin-tubes") {
    return shapes::GenerateFigure(shapes::GrowBranches(kThinTubes, 0), {.points = points});
  }
  BCCSKEL_ASSIGN_OR_RETURN(const Shape shape, ParseShapeName(name));
  const double noise = shape == Shape::kBlob ? kBlobNoise : 0;
  return GenerateShape(shape, {.points = points, .noise = noise});
}

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
