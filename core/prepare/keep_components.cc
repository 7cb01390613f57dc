#include "core/prepare/keep_components.h"

#include <algorithm>
#include <vector>

#include "core/certificate/component_sets.h"

namespace bccskel {
namespace {

// The size of each component by name; 0 for unused names.
std::vector<uint64_t> SizesOf(const Volume& object, ComponentSets& sets) {
  std::vector<uint64_t> sizes(sets.name_limit());
  const PhaseComponents& pieces = sets.pieces();
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    sizes[sets.SetOf(n)] += pieces.mains()[n].Count();
    const BrickFragments* split = pieces.fragments(n);
    if (split == nullptr) continue;
    split->fragments.ForEachSetBit([&](int bit) { ++sizes[sets.SetOf(pieces.NumberOf(n, bit))]; });
  }
  return sizes;
}

int FirstBit(const BrickBits& points) {
  int bit = 0;
  while (!points.Test(bit)) ++bit;
  return bit;
}

// The component of `size` points with the first point. Needs: there is one.
size_t FirstOfSize(ComponentSets& sets, const std::vector<uint64_t>& sizes, uint64_t size) {
  const auto fits = [&](size_t set) { return sizes[set] == size; };
  for (BrickIndex n = 0;; ++n) {
    const BrickBits points = sets.PointsWhere(n, fits);
    if (!points.Empty()) return sets.SetOf(sets.pieces().NumberOf(n, FirstBit(points)));
  }
}

// The object with only the components that pass.
template <typename Stays>
ChangedVolume Keep(const Volume& object, ComponentSets& sets, Stays stays) {
  ChangedVolume kept;
  std::vector<BrickKey> keys(object.keys().begin(), object.keys().end());
  std::vector<BrickBits> bricks(object.brick_count());
  for (BrickIndex n = 0; n < bricks.size(); ++n) {
    bricks[n] = sets.PointsWhere(n, stays);
    kept.points_removed += object.bricks()[n].Count() - bricks[n].Count();
  }
  kept.object = Volume::FromSortedBricks(object.extent(), object.placement(), std::move(keys),
                                         std::move(bricks));
  return kept;
}

}  // namespace

absl::StatusOr<ChangedVolume> DropSmallComponents(const Volume& object, uint64_t least,
                                                  const exec::Context& context) {
  ComponentSets sets(object, Phase::kObject, context);
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  const std::vector<uint64_t> sizes = SizesOf(object, sets);
  const auto dropped =
      std::ranges::count_if(sizes, [least](uint64_t size) { return size > 0 && size < least; });
  if (dropped == 0) return ChangedVolume{object};
  ChangedVolume kept = Keep(object, sets, [&](size_t set) { return sizes[set] >= least; });
  kept.count = static_cast<uint64_t>(dropped);
  return kept;
}

absl::StatusOr<ChangedVolume> KeepLargestComponent(const Volume& object,
                                                   const exec::Context& context) {
  ComponentSets sets(object, Phase::kObject, context);
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  if (sets.count() <= 1) return ChangedVolume{object};
  const std::vector<uint64_t> sizes = SizesOf(object, sets);
  const size_t largest = FirstOfSize(sets, sizes, *std::ranges::max_element(sizes));
  ChangedVolume kept = Keep(object, sets, [&](size_t set) { return set == largest; });
  kept.count = static_cast<uint64_t>(sets.count() - 1);
  return kept;
}

}  // namespace bccskel
