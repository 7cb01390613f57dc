#include "core/prepare/fill_tunnels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/lattice/directions.h"
#include "tests/core/prepare/reference_prepare.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/sanitized.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

using test::IsIn;
using test::Points;
using test::RandomCloud;

ChangedVolume Filled(const Volume& object, double width, int threads = 1) {
  test::TeamContext context(threads);
  exec::UnlimitedMemory memory;
  auto filled = FillTunnels(object, width, memory, context);
  EXPECT_TRUE(filled.ok()) << filled.status();
  return *std::move(filled);
}

double SquaredDistance(LatticePoint a, LatticePoint b) {
  const LatticePoint d = a - b;
  return Dot(d, d);
}

// From the definition: no place that is `radius` away from the object is nearer to p than that.
bool IsInClosing(LatticePoint p, const Points& object, double radius) {
  const auto reach = static_cast<int32_t>(std::ceil(radius));
  for (int32_t z = -reach; z <= reach; ++z) {
    for (int32_t y = -reach; y <= reach; ++y) {
      for (int32_t x = -reach; x <= reach; ++x) {
        const LatticePoint q = p + LatticePoint{x, y, z};
        if (!IsOnLattice(q) || SquaredDistance(p, q) >= radius * radius) continue;
        const bool is_free = std::ranges::all_of(
            object, [&](LatticePoint o) { return SquaredDistance(o, q) >= radius * radius; });
        if (is_free) return false;
      }
    }
  }
  return true;
}

TEST(FillTunnelsLaw, TakesLoopsAndNothingElse) {
  uint64_t filled = 0;
  for (uint64_t seed = 0; seed < 20; seed += test::kStride) {
    const double density = 0.02 + 0.93 * static_cast<double>(seed % 20) / 19;
    const Volume object = VolumeOfPoints(RandomCloud(seed, {35, 9, 10}, density));
    const BettiNumbers before = test::BettiOf(object);
    for (const double width : {0.5, 1.5, 4.0, 11.0}) {
      const ChangedVolume changed = Filled(object, width);
      BettiNumbers expected = before;
      expected.loops -= static_cast<int64_t>(changed.count);
      ASSERT_EQ(test::BettiOf(changed.object), expected) << "seed " << seed << ", width " << width;
      EXPECT_EQ(changed.object.PointCount(), object.PointCount() + changed.points_added);
      EXPECT_EQ(changed.count == 0, changed.points_added == 0);
      object.ForEachPoint([&](LatticePoint p) { ASSERT_TRUE(changed.object.Contains(p)); });
      EXPECT_TRUE(changed.object == Filled(object, width, 3).object);
      filled += changed.count;
    }
  }
  EXPECT_GT(filled, 100u);
}

TEST(FillTunnelsLaw, FillsOnlyWhatTheBallDoesNotReach) {
  for (uint64_t seed = 0; seed < 12; seed += test::kStride) {
    const Points points = RandomCloud(seed, {17, 9, 10}, 0.3 + 0.05 * static_cast<double>(seed));
    const Volume object = VolumeOfPoints(points);
    for (const double width : {0.5, 2.0}) {  // one ball
      Filled(object, width).object.ForEachPoint([&](LatticePoint p) {
        if (object.Contains(p)) return;
        EXPECT_TRUE(IsInClosing(p, points, width / 2 + 1)) << "seed " << seed;
      });
    }
  }
}

// A plate with a round hole, which is what it is told: `hole` wide.
IsIn PlateWithHole(double hole) {
  return [hole](double x, double y, double z) {
    return std::abs(z - 40) <= 6 && std::max(std::abs(x - 40), std::abs(y - 40)) <= 30 &&
           std::hypot(x - 40, y - 40) > hole / 2 + 1;
  };
}

TEST(FillTunnels, FillsTheNarrowOnes) {
  for (const double hole : {4.0, 9.0, 16.0}) {
    const Volume plate = test::VolumeWhere({41, 41, 41}, PlateWithHole(hole));
    ASSERT_EQ(test::BettiOf(plate), (BettiNumbers{1, 1, 0}));
    EXPECT_TRUE(Filled(plate, 0.7 * hole).object == plate) << hole;
    EXPECT_EQ(Filled(plate, 1.5 * hole).count, 1u) << hole;
    EXPECT_EQ(test::BettiOf(Filled(plate, 1.5 * hole).object), (BettiNumbers{1, 0, 0})) << hole;
  }
}

// What a wide ball leaves joins the tunnel to the gap between the two.
TEST(FillTunnels, FillsNarrowOnesBesideAnotherComponent) {
  const Volume object = test::VolumeWhere({41, 41, 41}, [](double x, double y, double z) {
    if (std::max(std::abs(x - 40), std::abs(y - 40)) > 20) return false;
    return (z >= 52 && z <= 68) || (z >= 20 && z <= 36 && std::hypot(x - 40, y - 40) > 3);
  });
  ASSERT_EQ(test::BettiOf(object), (BettiNumbers{2, 1, 0}));
  for (const double width : {10.0, 24.0}) {
    EXPECT_EQ(test::BettiOf(Filled(object, width).object), (BettiNumbers{2, 0, 0})) << width;
  }
}

// At the border of the extent there is no wall.
TEST(FillTunnels, SeesNoWallAtTheExtent) {
  const Volume plate = test::VolumeWhere(
      {16, 16, 16}, [](double x, double y, double) { return std::hypot(x - 15, y - 15) > 12; });
  ASSERT_EQ(test::BettiOf(plate).loops, 1);
  EXPECT_TRUE(Filled(plate, 12).object == plate);
  EXPECT_EQ(test::BettiOf(Filled(plate, 36).object), (BettiNumbers{1, 0, 0}));
}

IsIn Bottle(int mouths) {
  return [mouths](double x, double y, double z) {
    const double r = std::hypot(x - 40, y - 40, z - 40);
    const bool in_mouth = std::hypot(x - 40, y - 40) <= 4 && (z > 40 || mouths == 2);
    return r <= 34 && r >= 24 && !in_mouth;
  };
}

TEST(FillTunnels, LeavesABottleOneMouth) {
  for (const int mouths : {1, 2}) {
    const Volume bottle = test::VolumeWhere({41, 41, 41}, Bottle(mouths));
    ASSERT_EQ(test::BettiOf(bottle), (BettiNumbers{1, mouths - 1, 0}));
    EXPECT_EQ(test::BettiOf(Filled(bottle, 14).object), (BettiNumbers{1, 0, 0}));
  }
}

// Pores are wider than the passages between them and from the outer ones to the outside.
TEST(FillTunnels, TakesAllLoopsOfASponge) {
  const Volume sponge = test::VolumeWhere({41, 41, 41}, [](double x, double y, double z) {
    const auto to_pore = [](double t) { return std::abs(std::remainder(t - 40, 20)); };
    const double dx = to_pore(x), dy = to_pore(y), dz = to_pore(z);
    const double passage = std::min({std::hypot(dx, dy), std::hypot(dy, dz), std::hypot(dx, dz)});
    return std::max({std::abs(x - 40), std::abs(y - 40), std::abs(z - 40)}) <= 30 &&
           std::hypot(dx, dy, dz) > 7 && passage > 2.5;
  });
  ASSERT_EQ(test::BettiOf(sponge), (BettiNumbers{1, 81, 0}));
  EXPECT_EQ(test::BettiOf(Filled(sponge, 6).object), (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(test::BettiOf(Filled(sponge, 24).object), (BettiNumbers{1, 0, 0}));
}

TEST(FillTunnels, LeavesCavitiesAndNeighborsAlone) {
  const Volume two = test::VolumeWhere({41, 41, 41}, [](double x, double y, double z) {
    const double r = std::hypot(x - 20, y - 40, z - 40);
    return (r <= 18 && r >= 3) || std::hypot(x - 61, y - 40, z - 40) <= 19;
  });
  ASSERT_EQ(test::BettiOf(two), (BettiNumbers{2, 0, 1}));
  EXPECT_TRUE(Filled(two, 20).object == two);
}

TEST(FillTunnels, AsksForMemory) {
  class NoMemory final : public exec::MemoryBudget {
   public:
    absl::Status Take(uint64_t, const std::string& what_for) override {
      return absl::ResourceExhaustedError(what_for);
    }
    void GiveBack(uint64_t) override {}
  };
  NoMemory memory;
  const auto filled =
      FillTunnels(test::VolumeWhere({41, 41, 41}, PlateWithHole(9)), 12, memory, {});
  EXPECT_EQ(filled.status().code(), absl::StatusCode::kResourceExhausted);
}

// Remembers what is asked for, up to a limit.
class CountedMemory final : public exec::MemoryBudget {
 public:
  explicit CountedMemory(uint64_t limit) : limit_(limit) {}
  absl::Status Take(uint64_t bytes, const std::string& what_for) override {
    ++requests_;
    if (held_ + bytes > limit_) return absl::ResourceExhaustedError(what_for);
    held_ += bytes;
    most_ = std::max(most_, held_);
    return absl::OkStatus();
  }
  void GiveBack(uint64_t bytes) override { held_ -= bytes; }
  uint64_t most() const { return most_; }
  int requests() const { return requests_; }

 private:
  uint64_t limit_, held_ = 0, most_ = 0;
  int requests_ = 0;
};

Volume Dust() {
  VolumeBuilder builder({400, 400, 400});
  for (int32_t n = 0; n < 216; ++n) {
    builder.Add({60 + 120 * (n % 6), 60 + 120 * (n / 6 % 6), 60 + 120 * (n / 36)});
  }
  return *std::move(builder).Build();
}

// A distance field around a point would have 270 bricks.
TEST(FillTunnels, LooksAtFewBricksAroundDust) {
  CountedMemory memory(uint64_t{1} << 40);
  ASSERT_TRUE(FillTunnels(Dust(), 12, memory, {}).ok());
  EXPECT_LE(memory.most(), 216 * 100 * uint64_t{5120});
}

TEST(FillTunnels, KnowsAtOnceThatTheWidestTakesTooMuch) {
  CountedMemory memory(uint64_t{64} << 20);
  EXPECT_EQ(FillTunnels(Dust(), 64, memory, {}).status().code(),
            absl::StatusCode::kResourceExhausted);
  EXPECT_LE(memory.requests(), 2);
}

}  // namespace
}  // namespace bccskel
