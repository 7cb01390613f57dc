#include "core/pruning/largest_run.h"

#include <limits>
#include <utility>
#include <vector>

namespace bccskel {
namespace {

constexpr size_t kMostSamples = 48;

}  // namespace

Run LargestRun(const ThinSet& set, const BranchPath& path, const SurfaceNoise& noise,
               size_t first) {
  const size_t last = path.points.size() - 1, stride = (last - first) / kMostSamples + 1;
  std::vector<std::pair<size_t, double>> samples;  // positions and radii
  for (size_t n = first; n < last; n += stride) samples.emplace_back(n, path.radii[n]);
  samples.emplace_back(last, path.radii[last]);
  Run best{.ratio = -std::numeric_limits<double>::infinity()};
  for (size_t i = 0; i + 1 < samples.size(); ++i) {
    const auto [from, depth] = samples[i];
    Run run{.from = from, .elongation = -std::numeric_limits<double>::infinity()};
    for (size_t j = i + 1; j < samples.size(); ++j) {
      const auto [to, radius] = samples[j];
      const double way = set.Between(path.points[from], path.points[to]);
      const double out = way - kSteepness * (depth - radius);
      if (out > run.elongation) run.to = to, run.elongation = out;
    }
    const double stretch = noise.Stretch(set.Way(path.points[from], path.points[run.to]));
    run.ratio = (run.elongation - stretch * noise.At(depth)) / depth;
    if (run.ratio > best.ratio) best = run;
  }
  return best;
}

}  // namespace bccskel
