#include "core/pruning/largest_run.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace bccskel {
namespace {

constexpr size_t kMostSamples = 48;

// Positions along the path, and radii.
std::vector<std::pair<size_t, double>> SamplesOf(const BranchPath& path, size_t first) {
  const size_t last = path.points.size() - 1, stride = (last - first) / kMostSamples + 1;
  std::vector<std::pair<size_t, double>> samples;
  for (size_t n = first; n < last; n += stride) samples.emplace_back(n, path.radii[n]);
  samples.emplace_back(last, path.radii[last]);
  return samples;
}

}  // namespace

double LargestElongation(const ThinSet& set, const BranchPath& path) {
  double largest = 0;
  const auto samples = SamplesOf(path, 0);
  for (size_t i = 0; i + 1 < samples.size(); ++i) {
    for (size_t j = i + 1; j < samples.size(); ++j) {
      const double way = set.Between(path.points[samples[i].first], path.points[samples[j].first]);
      largest = std::max(largest, way - kSteepness * (samples[i].second - samples[j].second));
    }
  }
  return largest;
}

Run LargestRun(const ThinSet& set, const BranchPath& path, const SurfaceNoise& noise,
               size_t first) {
  const auto samples = SamplesOf(path, first);
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
