// Blunt snouts and pointed ears of heads, in which thinning keeps a curve in one pose and none in
// another.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/sampled.h"

namespace bccskel {
namespace {

using test::GapAt;
using test::Joined;
using test::ToLimb;

constexpr int32_t kCells = 112;

// A neck, a head, a snout that is blunt and thinner than the head, and two pointed ears.
struct Head {
  double head, snout, blunt, ear, root, spread, fillet, turn;

  WorldPoint Snout() const { return {0, -0.2 * head, head * (snout + blunt)}; }
  WorldPoint Ear(int side) const {
    return {side * std::sin(spread) * ear * head, std::cos(spread) * ear * head, 0.1 * head};
  }
  bool Contains(const WorldPoint& p) const {
    double distance = ToLimb(p, {0, 0, -100}, 0.9 * head, {0, 0, -50}, 0.9 * head);
    distance = Joined(distance, ToLimb(p, {0, 0, -50}, 0.8 * head, {0, 0, 0}, head), fillet);
    const WorldPoint to = {0, -0.2 * head, head * snout};
    distance = Joined(distance, ToLimb(p, {0, 0, 0}, 0.7 * head, to, blunt * head), fillet);
    for (const int side : {-1, 1}) {
      const WorldPoint tip = Ear(side), from = {0.4 * tip[0], 0.4 * tip[1], 0.4 * tip[2]};
      const double to_ear = ToLimb(p, from, root * head, tip, 0.06 * head);
      distance = Joined(distance, to_ear, fillet / 2);
    }
    return distance <= 0;
  }
};

TEST(MissedLimbs, Search) {
  std::mt19937 random(std::getenv("SEED") ? std::atoi(std::getenv("SEED")) : 1);
  const auto uniform = [&](double a, double b) { return a + (b - a) * (random() / 4294967296.0); };
  for (int n = 0; n < 60; ++n) {
    Head h;
    h.head = uniform(28, 46), h.snout = uniform(0.7, 1.3), h.blunt = uniform(0.4, 0.7), h.ear = uniform(1.5, 2.2);
    h.root = uniform(0.25, 0.6), h.spread = uniform(0.4, 0.9), h.fillet = uniform(0.2, 0.6) * h.head, h.turn = uniform(0, 3);
    const auto result = Skeletonize(test::Sampled([&](const WorldPoint& p) { return h.Contains(p); }, kCells, h.turn), {}, {});
    ASSERT_TRUE(result.ok());
    const auto ends = std::ranges::count(result->graph.nodes, NodeKind::kEnd, &SkeletonNode::kind);
    std::printf("%d {%.2f, %.3f, %.3f, %.3f, %.3f, %.3f, %.2f, %.3f} ends %d snout %d ears %d %d gaps %.2f %.2f %.2f\n", n, h.head, h.snout, h.blunt, h.ear, h.root, h.spread, h.fillet, h.turn, (int)ends,
      GapAt(h.Snout(), result->graph, kCells, h.turn) < 0.8 * h.head, GapAt(h.Ear(-1), result->graph, kCells, h.turn) < 0.8 * h.head, GapAt(h.Ear(1), result->graph, kCells, h.turn) < 0.8 * h.head,
      GapAt(h.Snout(), result->graph, kCells, h.turn)/h.head, GapAt(h.Ear(-1), result->graph, kCells, h.turn)/h.head, GapAt(h.Ear(1), result->graph, kCells, h.turn)/h.head);
  }
}

}  // namespace
}  // namespace bccskel
