#include "core/thinning/shell_opener.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "core/distance/distance_field.h"
#include "core/thinning/thinning_state.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

// An object with its shells, and what opening them changes.
struct Opening {
  Volume object = VolumeOfPoints(test::RandomBlob(4, {50, 50, 60}, 6, 30));
  Shells shells = BuildShells(
      object, *ComputeDistance(object, DistanceKind::kChamfer, exec::Context()), 0.75, {});
  ThinningState state{object, {}};
  std::vector<DirtyMask> dirty = std::vector<DirtyMask>(groups() * kDirtyGroup);
  std::vector<uint8_t> busy = std::vector<uint8_t>(groups());
  std::vector<DirtyMask> enabled = dirty;

  size_t groups() const { return object.brick_count() / kDirtyGroup + 1; }
  OpeningView View() {
    return {.object = state.object.data(),
            .candidates = state.candidates.data(),
            .dirty = {dirty.data(), busy.data()},
            .enabled = enabled.data(),
            .watched = kDirectionsDirty,
            .woken = kDirectionsDirty};
  }
  std::map<int32_t, uint64_t> PointsByShell() const {
    std::map<int32_t, uint64_t> points;
    for (BrickIndex n = 0; n < object.brick_count(); ++n) {
      const int32_t first = shells.RangeOf(n).first;
      object.bricks()[n].ForEachSetBit([&](int bit) {
        int32_t shell = 0;
        for (size_t b = 0; b < kShellPlanes; ++b) {
          shell |= (shells.planes()[n][b].Test(bit) ? 1 : 0) << b;
        }
        ++points[first + ((shell - first) & 63)];
      });
    }
    return points;
  }
  uint64_t Candidates() const {
    uint64_t count = 0;
    for (BrickIndex n = 0; n < object.brick_count(); ++n) count += state.candidates[n].Count();
    return count;
  }
};

TEST(ShellOpener, MakesThePointsOfEachShellCandidatesAndWakesTheirBricks) {
  Opening opening;
  const auto expected = opening.PointsByShell();
  ASSERT_GT(opening.shells.last(), 2 * kShellsAtOnce);
  ShellOpener opener;
  opener.Begin(opening.shells, {0, opening.object.brick_count()});
  uint64_t opened = 0;
  for (int32_t shell = 1; shell <= opening.shells.last(); ++shell) {
    const uint64_t points = opener.Open(opening.View(), shell);
    ASSERT_EQ(points, expected.contains(shell) ? expected.at(shell) : 0) << shell;
    opened += points;
    ASSERT_EQ(opening.Candidates(), opened);
  }
  EXPECT_EQ(opened, opening.object.PointCount());
  for (BrickIndex n = 0; n < opening.object.brick_count(); ++n) {
    EXPECT_EQ(opening.enabled[n], kDirectionsDirty);
    EXPECT_EQ(opening.dirty[n], kDirectionsDirty);
  }
}

TEST(ShellOpener, GoesOnWithTheBricksThatItTakesOver) {
  Opening opening;
  const auto expected = opening.PointsByShell();
  const size_t half = opening.object.brick_count() / 2;
  ShellOpener low, high;
  low.Begin(opening.shells, {0, half});
  high.Begin(opening.shells, {half, opening.object.brick_count()});
  for (int32_t shell = 1; shell <= opening.shells.last(); ++shell) {
    if (shell == 6) low.TakeOver(high);
    uint64_t points = low.Open(opening.View(), shell);
    if (shell < 6) points += high.Open(opening.View(), shell);
    ASSERT_EQ(points, expected.contains(shell) ? expected.at(shell) : 0) << shell;
  }
}

}  // namespace
}  // namespace bccskel
