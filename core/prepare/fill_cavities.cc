#include "core/prepare/fill_cavities.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/certificate/brick_sum.h"
#include "core/certificate/component_sets.h"

namespace bccskel {
namespace {

using Gap = BackgroundGaps::Gap;

std::vector<Gap> EnclosedGaps(ComponentSets& background) {
  std::vector<Gap> enclosed;
  const BackgroundGaps& gaps = background.gaps();
  for (size_t place = 0; place < gaps.place_count(); ++place) {
    const std::optional<Gap> gap = gaps.GapBefore(place);
    if (!gap.has_value() || background.IsOutside(background.SetOfGap(gap->node))) continue;
    enclosed.push_back(*gap);
  }
  return enclosed;
}

uint64_t BrickCount(const std::vector<Gap>& gaps) {
  uint64_t bricks = 0;
  for (const Gap& gap : gaps) bricks += gap.BrickCount();
  return bricks;
}

// Increasing.
std::vector<BrickKey> KeysOf(const std::vector<Gap>& gaps) {
  std::vector<BrickKey> keys;
  keys.reserve(BrickCount(gaps));
  for (const Gap& gap : gaps) {
    for (BrickCoordinates brick = gap.first; brick.bx <= gap.last_x; ++brick.bx) {
      keys.push_back(BrickKey(brick));
    }
  }
  std::ranges::sort(keys);
  return keys;
}

// Fills the enclosed points of stored bricks. Returns how many.
uint64_t FillStored(ComponentSets& background, std::vector<BrickBits>& bricks,
                    const exec::Context& context) {
  const auto enclosed = [&](size_t set) { return !background.IsOutside(set); };
  const int64_t filled = SumOverBricks(context, bricks.size(), [&](int, exec::Share batch) {
    int64_t points = 0;
    for (size_t n = batch.begin; n < batch.end; ++n) {
      const BrickBits found = background.PointsWhere(static_cast<BrickIndex>(n), enclosed);
      if (found.Empty()) continue;
      points += static_cast<int64_t>(found.Count());
      bricks[n] |= found;
    }
    return points;
  });
  return static_cast<uint64_t>(filled);
}

// The stored bricks and the full bricks between them.
Volume WithWholeBricks(const Volume& object, std::vector<BrickBits> stored,
                       const std::vector<BrickKey>& whole) {
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bricks;
  keys.reserve(stored.size() + whole.size());
  bricks.reserve(stored.size() + whole.size());
  auto next = whole.begin();
  for (size_t n = 0; n < stored.size(); ++n) {
    for (; next != whole.end() && *next < object.keys()[n]; ++next) {
      keys.push_back(*next);
      bricks.push_back(~BrickBits());
    }
    keys.push_back(object.keys()[n]);
    bricks.push_back(stored[n]);
  }
  return Volume::FromSortedBricks(object.extent(), object.placement(), std::move(keys),
                                  std::move(bricks));
}

}  // namespace

absl::StatusOr<ChangedVolume> FillCavities(const Volume& object, uint64_t max_bricks,
                                           const exec::Context& context) {
  ComponentSets background(object, Phase::kBackground, context);
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  const auto cavities = static_cast<uint64_t>(background.count() - 1);
  if (cavities == 0) return ChangedVolume{object};
  const std::vector<Gap> gaps = EnclosedGaps(background);
  const uint64_t more = BrickCount(gaps);
  if (object.brick_count() + more > max_bricks) {
    return absl::ResourceExhaustedError(absl::StrFormat(
        "filling the cavities gives an object of %d bricks of 512 points: must be at most %d",
        object.brick_count() + more, max_bricks));
  }
  std::vector<BrickBits> stored(object.bricks().begin(), object.bricks().end());
  const uint64_t filled = FillStored(background, stored, context);
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  return ChangedVolume{WithWholeBricks(object, std::move(stored), KeysOf(gaps)), cavities,
                       filled + more * kBrickPoints};
}

absl::StatusOr<uint64_t> BricksWithCavitiesFilled(const Volume& object,
                                                  const exec::Context& context) {
  ComponentSets background(object, Phase::kBackground, context);
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  return object.brick_count() + BrickCount(EnclosedGaps(background));
}

}  // namespace bccskel
