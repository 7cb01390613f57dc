#include "core/pruning/point_table.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace bccskel {
namespace {

void ExpectEqual(const PointTable<int>& table, const std::map<LatticePoint, int>& expected) {
  ASSERT_EQ(table.size(), expected.size());
  for (const auto& [p, value] : expected) {
    ASSERT_NE(table.Find(p), nullptr);
    ASSERT_EQ(*table.Find(p), value);
  }
  size_t seen = 0;
  table.ForEach([&](LatticePoint p, int value) {
    ++seen;
    EXPECT_EQ(expected.at(p), value);
  });
  EXPECT_EQ(seen, expected.size());
}

// Few places, so that most points come and go many times and share their ways.
TEST(PointTable, HoldsWhatAMapHolds) {
  std::mt19937 random(5);
  PointTable<int> table;
  std::map<LatticePoint, int> expected;
  for (int turn = 0; turn < 20'000; ++turn) {
    const auto next = [&] { return static_cast<int32_t>(random() % 8) - 2; };
    const LatticePoint p = {next(), next(), next()};
    if (random() % 2 == 0) {
      table.Set(p, turn);
      expected[p] = turn;
    } else if (expected.erase(p) > 0) {
      table.Remove(p);
    }
    ASSERT_EQ(table.Find(p) != nullptr, expected.contains(p));
    if (turn % 500 == 0) ExpectEqual(table, expected);
  }
  ExpectEqual(table, expected);
}

TEST(PointTable, GrowsAndKeepsRoomThatWasReserved) {
  for (size_t reserved : {size_t{0}, size_t{1000}}) {
    PointTable<int> table;
    table.Reserve(reserved);
    std::map<LatticePoint, int> expected;
    for (int32_t n = 0; n < 3000; ++n) {
      table.Set({2 * n, -2 * n, 0}, n);
      expected[{2 * n, -2 * n, 0}] = n;
    }
    ExpectEqual(table, expected);
  }
}

TEST(PointTable, IsEmptyAtFirst) {
  const PointTable<int> table;
  EXPECT_TRUE(table.empty());
  EXPECT_EQ(table.Find({0, 0, 0}), nullptr);
}

}  // namespace
}  // namespace bccskel
