// Ends of bodies that thin limbs leave before the end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/pipeline/skeletonize.h"
#include "core/pruning/prune.h"
#include "tests/core/pruning/sampled.h"
#include "tests/core/pruning/simple_noise.h"

namespace bccskel {
namespace {

using test::GapAt;
using test::Joined;
using test::ToLimb;

int64_t FreeEndsOf(const SkeletonGraph& graph) {
  return std::ranges::count(graph.nodes, NodeKind::kEnd, &SkeletonNode::kind);
}

// A pair of limbs leaves a spheroid three times as long as thick. Thinning keeps no curve between
// them and its end; where it keeps one, it narrows too fast for a limb.
TEST(BodyEnds, SpheroidsWithAPairOfLimbsHaveFourEnds) {
  constexpr int32_t kCells = 100;
  constexpr double kThick = 24, kLong = 3 * kThick, kLimb = 0.12 * kThick;
  const double focus = kLong - kThick * kThick / kLong;  // where the ridge ends
  for (const double place : {0.3, 0.5}) {
    const double x = place * kLong, y = kThick + 40;
    const auto solid = [&](const WorldPoint& p) {
      const double across = (p[1] * p[1] + p[2] * p[2]) / (kThick * kThick);
      return p[0] * p[0] / (kLong * kLong) + across <= 1 ||
             ToLimb(p, {x, -y, 0}, kLimb, {x, y, 0}, kLimb) <= 0;
    };
    for (const double turn : {0.0, 0.3, 0.8, 2.1}) {
      const auto result = Skeletonize(test::Sampled(solid, kCells, turn), {}, {});
      ASSERT_TRUE(result.ok()) << result.status();
      EXPECT_EQ(FreeEndsOf(result->graph), 4) << place << ' ' << turn;
      for (const double end : {-focus, focus}) {
        EXPECT_LT(GapAt({end, 0, 0}, result->graph, kCells, turn), 0.6 * kThick)
            << place << ' ' << turn << ' ' << end;
      }
    }
  }
}

// A snout narrows by half its length, and two ears leave the head beside it.
TEST(BodyEnds, SnoutsBesideTwoEarsStay) {
  constexpr int32_t kCells = 90;
  constexpr double kHead = 26;
  const WorldPoint center = {0, 0, 0}, body = {-80, 0, 0}, tip = {1.35 * kHead, 0, 0};
  const auto solid = [&](const WorldPoint& p) {
    const double neck = ToLimb(p, body, 0.7 * kHead, center, 0.7 * kHead);
    double out = Joined(neck, ToLimb(p, center, kHead, center, kHead), 4);
    out = Joined(out, ToLimb(p, center, 0.7 * kHead, tip, 0.35 * kHead), 4);
    for (const double side : {-1.0, 1.0}) {
      const WorldPoint ear = {-0.1 * kHead, side * kHead, 2 * kHead};
      out = std::min(out, ToLimb(p, {0, side * 0.4 * kHead, 0.5 * kHead}, 4, ear, 4));
    }
    return out <= 0;
  };
  for (const double turn : {0.0, 0.4, 1.0, 1.6, 2.8}) {
    const auto result = Skeletonize(test::Sampled(solid, kCells, turn), {}, {});
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(FreeEndsOf(result->graph), 4) << turn;
    EXPECT_LT(GapAt(tip, result->graph, kCells, turn), kHead / 2) << turn;
  }
}

// The curve turned into the twig, and what thinning left of the trunk's end was pruned.
TEST(BodyEnds, TrunksGoOnBeyondTheirLastTwig) {
  constexpr int32_t kCells = 100;
  constexpr double kTwig = 0.4;  // in radii of the trunk, as are the others
  for (const double thick : {12.0, 20.0}) {
    for (const double angle : {0.8, 1.05, 1.3}) {
      // How far the middle of the trunk's round end lies beyond the crotch.
      for (const double beyond : {-0.9, 0.25, 0.45}) {
        const double x = (beyond + 1 / std::tan(angle) + kTwig / std::sin(angle)) * thick;
        const double length = (1 + 6 * kTwig) * thick;
        const WorldPoint end = {x, 0, 0};
        const WorldPoint twig = {std::cos(angle) * length, std::sin(angle) * length, 0};
        const auto solid = [&](const WorldPoint& p) {
          return ToLimb(p, {-80, 0, 0}, thick, end, thick) <= 0 ||
                 ToLimb(p, {0, 0, 0}, kTwig * thick, twig, kTwig * thick) <= 0;
        };
        for (const double turn : {0.1, 0.7, 1.9}) {
          SCOPED_TRACE(testing::Message() << thick << ' ' << angle << ' ' << beyond << ' ' << turn);
          const auto result = Skeletonize(test::Sampled(solid, kCells, turn), {}, {});
          ASSERT_TRUE(result.ok()) << result.status();
          EXPECT_EQ(FreeEndsOf(result->graph), beyond > 0 ? 3 : 2);
          for (const SkeletonEdge& edge : result->graph.edges) {
            EXPECT_GE(edge.pruning_level, kDefaultSignificance);
          }
          const double gap = GapAt(end, result->graph, kCells, turn);
          EXPECT_TRUE(beyond < 0 || gap < thick / 4) << gap;
        }
      }
    }
  }
}

// The face beyond the limbs sticks out by less than the bar is thick, and its corners are no ends.
TEST(BodyEnds, FacesAndCapsJustBeyondLimbsHaveNone) {
  constexpr int32_t kCells = 90;
  constexpr double kThick = 18, kLimb = 4;
  for (const bool round : {false, true}) {
    const auto solid = [&](const WorldPoint& p) {
      const double along = round ? std::max(p[0] - 40, 0.0) : 0;
      const double across =
          round ? std::hypot(along, p[1], p[2]) : std::max(std::abs(p[1]), std::abs(p[2]));
      return (across <= kThick && p[0] >= -80 && p[0] <= (round ? 80 : 58)) ||
             ToLimb(p, {44, -60, 0}, kLimb, {44, 60, 0}, kLimb) <= 0;
    };
    for (const double turn : {0.0, 0.3, 0.8, 2.1}) {
      const auto result = Skeletonize(test::Sampled(solid, kCells, turn), {}, {});
      ASSERT_TRUE(result.ok()) << result.status();
      EXPECT_EQ(FreeEndsOf(result->graph), 3) << round << ' ' << turn;
    }
  }
}

// The ball of the junction nearest to the end holds the middle of the cap, where the tip lies.
TEST(BodyEnds, TipsLieInTheCapsThatTheLastLimbsAreNear) {
  constexpr int32_t kCells = 80;
  constexpr double kBody = 24, kLimb = 4;
  for (const double near : {0.8, 0.9}) {
    for (const double turn : {0.3, 0.8, 2.1}) {
      for (const uint64_t seed : {1u, 2u, 3u}) {
        const auto solid = [&](const WorldPoint& p) {
          double out = ToLimb(p, {-40, 0, 0}, kBody, {40, 0, 0}, kBody);
          for (const double side : {-1.0, 1.0}) {
            const WorldPoint from = {side * (40 - near * kBody), 0, 0};
            out = std::min(out, ToLimb(p, from, kLimb, {from[0], 0, 56}, kLimb));
          }
          return out <= 0;
        };
        const Volume object = test::WithSimpleNoise(test::Sampled(solid, kCells, turn), 0.1, seed);
        const auto result = Skeletonize(object, {}, {});
        ASSERT_TRUE(result.ok()) << result.status();
        SCOPED_TRACE(testing::Message() << near << ' ' << turn << ' ' << seed);
        EXPECT_EQ(FreeEndsOf(result->graph), 4);
        for (const double end : {-40.0, 40.0}) {
          EXPECT_LT(GapAt({end, 0, 0}, result->graph, kCells, turn), 5) << end;
        }
      }
    }
  }
}

}  // namespace
}  // namespace bccskel
