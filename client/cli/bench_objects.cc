#include "client/cli/bench_objects.h"

#include <algorithm>
#include <string>

#include "absl/strings/str_join.h"
#include "core/exec/status_macros.h"
#include "core/import/shapes/branching.h"
#include "core/import/shapes/figures.h"
#include "core/import/shapes/shapes.h"

namespace bccskel::cli {
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

}  // namespace bccskel::cli
