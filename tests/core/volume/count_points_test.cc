#include "core/volume/count_points.h"

#include <gtest/gtest.h>

#include <bitset>
#include <random>
#include <string>
#include <vector>

#include "core/exec/instruction_sets.h"

namespace bccskel {
namespace {

TEST(CountPoints, CountsEveryBitOnEveryInstructionSet) {
  std::mt19937_64 random(1);
  std::vector<BrickBits> bricks(37);
  uint64_t expected = 0;
  for (BrickBits& brick : bricks) {
    for (uint64_t& word : brick.words) {
      word = random();
      expected += std::bitset<64>(word).count();
    }
  }
  for (const std::string& name : exec::SupportedInstructionSets()) {
    ASSERT_TRUE(exec::ChooseInstructionSet(name));
    EXPECT_EQ(CountPoints(bricks), expected) << name;
    EXPECT_EQ(CountPoints({}), 0u) << name;
  }
  exec::ChooseInstructionSet("");
}

}  // namespace
}  // namespace bccskel
