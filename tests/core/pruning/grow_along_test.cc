#include "core/pruning/grow_along.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace bccskel {
namespace {

// A straight branch along x, in a grid with room on all sides.
class GrowAlongTest : public testing::Test {
 protected:
  GrowAlongTest() {
    VolumeBuilder builder({40, 40, 40});
    for (int32_t x = 10; x <= 30; x += 2) path_.push_back({x, 40, 40});
    for (const LatticePoint p : path_) builder.Add(p);
    set_.emplace(ThinSkeleton{*std::move(builder).Build(), std::vector<float>(11, 3)});
  }

  std::vector<LatticePoint> path_;
  std::optional<ThinSet> set_;
  const std::vector<Coordinates> places_ = {{20, 40, 40}, {24, 44, 42}, {28, 50, 46}, {32, 56, 50}};
};

TEST_F(GrowAlongTest, ReplacesTheEndByACurveThatTouchesNothingElse) {
  ASSERT_TRUE(GrowAlong(
      places_, 5, [](LatticePoint) { return true; }, path_, *set_));
  EXPECT_EQ(path_[5], (LatticePoint{20, 40, 40}));
  EXPECT_LT(set_->Between(path_.back(), places_.back()), 3);
  EXPECT_EQ(set_->Ends(), (std::vector<LatticePoint>{path_.front(), path_.back()}));
  for (size_t n = 1; n + 1 < path_.size(); ++n)
    EXPECT_TRUE(IsCurvePoint(set_->NeighborsOf(path_[n]))) << n;
}

TEST_F(GrowAlongTest, ChangesNothingWhereTheLastPlaceIsNotReached) {
  const std::vector<LatticePoint> before = path_;
  EXPECT_FALSE(GrowAlong(
      places_, 5, [](LatticePoint p) { return p.y < 48; }, path_, *set_));
  EXPECT_EQ(path_, before);
  for (const LatticePoint p : before) EXPECT_EQ(set_->RadiusOf(p), 3);
  EXPECT_EQ(set_->Ends(), (std::vector<LatticePoint>{before.front(), before.back()}));
}

}  // namespace
}  // namespace bccskel
