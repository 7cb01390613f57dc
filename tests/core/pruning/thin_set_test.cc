#include "core/pruning/thin_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

constexpr LatticeExtent kExtent = {6, 6, 6};

std::vector<LatticePoint> AllPlaces() { return test::RandomCloud(1, kExtent, 1); }

ThinSet SetOf(const std::vector<LatticePoint>& points) {
  return ThinSet({VolumeOfPoints(points), std::vector<float>(points.size(), 1)});
}

void ExpectEqual(const ThinSet& a, const ThinSet& b) {
  for (LatticePoint p : AllPlaces()) {
    ASSERT_EQ(a.Contains(p), b.Contains(p));
    if (!a.Contains(p)) continue;
    ASSERT_EQ(a.NeighborsOf(p), b.NeighborsOf(p));
    ASSERT_EQ(a.RadiusOf(p), b.RadiusOf(p));
  }
}

// Removes points, adds others and sets radii, the same for each set.
void ChangeSome(unsigned seed, ThinSet& set) {
  std::mt19937 random(seed);
  std::vector<LatticePoint> places = AllPlaces();
  std::ranges::shuffle(places, random);
  for (size_t n = 0; n < places.size() / 4; ++n) {
    const LatticePoint p = places[n];
    if (!set.Contains(p)) {
      set.Add(p, 2);
    } else if (n % 3 == 0) {
      set.SetRadius(p, 3);
    } else {
      set.Remove(p);
      if (n % 3 == 1) set.Add(p, 4);
    }
  }
}

TEST(ThinSet, OverAnotherIsLikeACopyAndLeavesTheOther) {
  const ThinSet below = SetOf(test::RandomCloud(2, kExtent, 0.5));
  ThinSet over = ThinSet::Over(below);
  ExpectEqual(over, below);
  for (unsigned seed = 0; seed < 5; ++seed) {
    ThinSet copy = below, changed = below;
    ChangeSome(seed, copy);
    ChangeSome(seed, over);
    ExpectEqual(over, copy);
    ASSERT_TRUE(changed.Apply(over.TakeChanges()));
    ExpectEqual(changed, copy);
    ExpectEqual(over, below);  // it forgot the changes
  }
}

// A curve along x, of every second even place.
std::vector<LatticePoint> Row(int32_t y) {
  std::vector<LatticePoint> row;
  for (int32_t x = 0; x < 10; x += 2) row.push_back({x, y, 2});
  return row;
}

TEST(ThinSet, DoesNotApplyWhatNoLongerFits) {
  const ThinSet before = SetOf(Row(2));
  ThinSet over = ThinSet::Over(before);
  over.Add({10, 2, 2}, 1);  // the next of the row
  const std::vector<ThinSet::Change> grown = over.TakeChanges();
  over.Remove({8, 2, 2});
  const std::vector<ThinSet::Change> cut = over.TakeChanges();
  const auto expect_refused = [](const std::vector<ThinSet::Change>& changes, ThinSet set) {
    const ThinSet unchanged = set;
    EXPECT_FALSE(set.Apply(changes));
    ExpectEqual(set, unchanged);
  };
  ThinSet now = before;
  EXPECT_TRUE(now.Apply(grown));
  expect_refused(grown, now);  // the point is there
  expect_refused(cut, now);    // its last point has another neighbor
  now = before;
  now.Remove({8, 2, 2});
  expect_refused(grown, now);  // the neighbor is gone
  expect_refused(cut, now);
  now = before;
  now.Add({11, 3, 3}, 1);  // beside the new point, but beside no other
  expect_refused(grown, now);
  EXPECT_TRUE(now.Apply(cut));
  now = before;
  now.Add({2, 4, 2}, 1);  // far from it
  EXPECT_TRUE(now.Apply(grown));
}

}  // namespace
}  // namespace bccskel
