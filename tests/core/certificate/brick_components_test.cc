#include "core/certificate/brick_components.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

#include "core/exec/instruction_sets.h"
#include "core/lattice/directions.h"
#include "tests/support/sanitized.h"

namespace bccskel {
namespace {

constexpr BrickCoordinates kBrick = {1, 1, 1, Sublattice::kEven};

// Flood fill, point by point: a label for each point of the brick.
std::vector<int> ReferenceLabels(const BrickBits& points, int& components) {
  std::vector<int> labels(kBrickPoints, -1);
  components = 0;
  for (int start = 0; start < kBrickPoints; ++start) {
    if (!points.Test(start) || labels[static_cast<size_t>(start)] >= 0) continue;
    std::vector<int> stack = {start};
    labels[static_cast<size_t>(start)] = components;
    while (!stack.empty()) {
      const LatticePoint p = PointOf(kBrick, stack.back());
      stack.pop_back();
      for (int d = 8; d < kNeighborCount; ++d) {
        const BrickAddress next = AddressOf(p + Direction(d).offset());
        if (next.brick != kBrick || !points.Test(next.bit)) continue;
        int& label = labels[static_cast<size_t>(next.bit)];
        if (label >= 0) continue;
        label = components;
        stack.push_back(next.bit);
      }
    }
    ++components;
  }
  return labels;
}

BrickBits RandomBrick(std::mt19937_64& random, double density) {
  BrickBits points;
  points.Set(static_cast<int>(random() % kBrickPoints));
  for (int bit = 0; bit < kBrickPoints; ++bit) {
    if (static_cast<double>(random() % 1000) < 1000 * density) points.Set(bit);
  }
  return points;
}

Connectivity ConnectivityOf(const BrickBits& points) {
  Connectivity found = Connectivity::kUnclear;
  BrickBits copy;
  TestConnectivity({&points, 1}, Phase::kObject, {&copy, 1}, {&found, 1});
  EXPECT_EQ(copy, points);
  return found;
}

BrickBits Complement(const BrickBits& points) {
  BrickBits others;
  for (size_t k = 0; k < others.words.size(); ++k) others.words[k] = ~points.words[k];
  return others;
}

class BrickComponents : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { ASSERT_TRUE(exec::ChooseInstructionSet(GetParam())); }
  void TearDown() override { exec::ChooseInstructionSet(""); }
};

TEST_P(BrickComponents, AgreeWithFloodFillOnRandomBricksOfAllDensities) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 600; round += test::kStride) {
    const BrickBits points = RandomBrick(random, (round % 100) / 100.0);
    int components = 0;
    const std::vector<int> reference = ReferenceLabels(points, components);
    const BrickFragments split = SplitBrick(points);
    ASSERT_EQ(split.components, components);
    std::set<std::pair<int, int>> pairs;
    points.ForEachSetBit([&](int bit) {
      const auto n = static_cast<size_t>(bit);
      pairs.insert({reference[n], split.labels[n]});
      EXPECT_EQ(split.fragments.Test(bit), split.labels[n] != 0);
    });
    EXPECT_EQ(pairs.size(), static_cast<size_t>(components)) << "labels are not one to one";
    EXPECT_EQ(IsConnected(points), components == 1);
    if (ConnectivityOf(points) == Connectivity::kConnected) {
      EXPECT_EQ(components, 1);
    }
  }
}

TEST_P(BrickComponents, FollowASnakeThroughTheBrick) {
  BrickBits points;
  for (int k = 0; k < 8; k += 2) {
    for (int cell = 0; cell < 64; ++cell) {
      const int i = cell & 15, j = cell >> 4;
      const bool turn = j % 2 == 1 && i == (j == 1 ? 15 : 0);
      if (j % 2 == 0 || turn) points.Set(64 * k + cell);
    }
    if (k > 0) points.Set(64 * (k - 1) + (k % 4 == 0 ? 0 : 47));
  }
  int components = 0;
  ReferenceLabels(points, components);
  EXPECT_EQ(SplitBrick(points).components, components);
}

TEST_P(BrickComponents, ACheckerboardHas256) {
  BrickBits points;
  for (int bit = 0; bit < kBrickPoints; ++bit) {
    if ((((bit & 15) + ((bit >> 4) & 3) + (bit >> 6)) & 1) == 0) points.Set(bit);
  }
  EXPECT_EQ(SplitBrick(points).components, 256);
  EXPECT_EQ(ConnectivityOf(points), Connectivity::kUnclear);
}

TEST_P(BrickComponents, OfTheBackgroundAreThoseOfTheComplement) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 100; round += test::kStride) {
    const BrickBits points = RandomBrick(random, 1 - 0.0005 * round);
    const BrickBits complement = Complement(points);
    Connectivity found = Connectivity::kUnclear;
    BrickBits background;
    TestConnectivity({&points, 1}, Phase::kBackground, {&background, 1}, {&found, 1});
    EXPECT_EQ(background, complement);
    EXPECT_EQ(found, complement.Empty() ? Connectivity::kEmpty : ConnectivityOf(complement));
  }
}

// The part of a half space in a brick, whatever its normal: the case that must be cheap.
TEST_P(BrickComponents, PartsOfHalfSpacesAreSeenToBeConnectedAtOnce) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 300; round += test::kStride) {
    int normal[3];
    for (int& n : normal) n = static_cast<int>(random() % 201) - 100;
    BrickBits points;
    for (int bit = 0; bit < kBrickPoints; ++bit) {
      const int f = normal[0] * ((bit & 15) - 8) + normal[1] * (((bit >> 4) & 3) - 2) +
                    normal[2] * ((bit >> 6) - 4);
      if (f <= 50) points.Set(bit);
    }
    if (!points.Empty()) {
      EXPECT_EQ(ConnectivityOf(points), Connectivity::kConnected);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllInstructionSets, BrickComponents,
                         testing::ValuesIn(exec::SupportedInstructionSets()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace bccskel
