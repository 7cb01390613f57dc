#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "core/lattice/directions.h"
#include "core/mask/mask_converter.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel {
namespace {

// Points within `radius` of the segment from a to b, in lattice units of a grid with this spacing.
Volume Capsule(std::array<double, 3> a, std::array<double, 3> b, double radius,
               std::array<double, 3> spacing) {
  const Placement placement = {.spacing = spacing};
  const auto cells = [&](size_t axis) {
    return static_cast<int32_t>(std::ceil((std::max(a[axis], b[axis]) + radius) / spacing[axis])) +
           2;
  };
  const LatticeExtent extent = {cells(0), cells(1), cells(2)};
  VolumeBuilder builder(extent, placement);
  const WorldPoint axis = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  for (Sublattice s : kSublattices) {
    for (int32_t k = 0; k < extent.nz; ++k) {
      for (int32_t j = 0; j < extent.ny; ++j) {
        for (int32_t i = 0; i < extent.nx; ++i) {
          const LatticePoint p = PointAt(s, i, j, k);
          const WorldPoint w = placement.ToWorld(p);
          const WorldPoint from = {w[0] - a[0], w[1] - a[1], w[2] - a[2]};
          const double t = std::clamp(Dot(from, axis) / Dot(axis, axis), 0.0, 1.0);
          const WorldPoint off = {from[0] - t * axis[0], from[1] - t * axis[1],
                                  from[2] - t * axis[2]};
          if (Dot(off, off) <= radius * radius) builder.Add(p);
        }
      }
    }
  }
  return *std::move(builder).Build();
}

double Gap(const WorldPoint& a, const WorldPoint& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(Tips, LieWhereTheAxisOfACapsuleEnds) {
  const std::array<double, 3> a = {12, 12, 12}, b = {60, 30, 24};
  const Volume object = Capsule(a, b, 8, {1, 1, 1});
  for (DistanceKind kind : {DistanceKind::kChamfer, DistanceKind::kEuclidean}) {
    SkeletonizeOptions options;
    options.distance = kind;
    const auto result = Skeletonize(object, options, {});
    ASSERT_TRUE(result.ok()) << result.status();
    const SkeletonGraph& graph = result->graph;
    ASSERT_EQ(graph.nodes.size(), 2u);
    const WorldPoint first = graph.PositionOf(graph.nodes[0].at),
                     second = graph.PositionOf(graph.nodes[1].at);
    EXPECT_LT(std::min(Gap(first, a), Gap(second, a)), 1.5);
    EXPECT_LT(std::min(Gap(first, b), Gap(second, b)), 1.5);
  }
}

// The skeleton of the voxels whose centers lie within `radius` of the segment, of edge 1 but along
// z.
SkeletonGraph GraphOfVoxels(const WorldPoint& a, const WorldPoint& b, double radius,
                            double edge_z = 1) {
  constexpr int32_t kEdge = 48;
  const MaskGrid grid = {kEdge, kEdge, kEdge, {.spacing = {1, 1, edge_z}}};
  absl::StatusOr<MaskConverter> converter = MaskConverter::Create(grid, {});
  EXPECT_TRUE(converter.ok()) << converter.status();
  const WorldPoint axis = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  for (int32_t z = 0; z < kEdge; ++z) {
    std::vector<uint64_t> words(kEdge);
    for (int32_t y = 0; y < kEdge; ++y) {
      for (int32_t x = 0; x < kEdge; ++x) {
        const WorldPoint at = {1.0 * x, 1.0 * y, edge_z * z};
        const WorldPoint from = {at[0] - a[0], at[1] - a[1], at[2] - a[2]};
        const double t = std::clamp(Dot(from, axis) / Dot(axis, axis), 0.0, 1.0);
        const WorldPoint nearest = {a[0] + t * axis[0], a[1] + t * axis[1], a[2] + t * axis[2]};
        if (Gap(at, nearest) > radius) continue;
        words[static_cast<size_t>(y)] |= uint64_t{1} << x;
      }
    }
    const absl::Status added = converter->AddSlice(words, {});
    EXPECT_TRUE(added.ok()) << added;
  }
  absl::StatusOr<ConvertedMask> converted = std::move(*converter).Finish();
  EXPECT_TRUE(converted.ok()) << converted.status();
  const SkeletonizeOptions options = {.source = ObjectSource::kVoxels,
                                      .voxel_slabs = SlabsOf(grid, VoxelPoints::kTwo)};
  absl::StatusOr<SkeletonizeResult> result = Skeletonize(converted->volume, options, {});
  EXPECT_TRUE(result.ok()) << result.status();
  return std::move(result->graph);
}

// A few lattice points do not tell a limb's direction where steps along z are four or six times as
// long.
TEST(Tips, FollowTheLimbOnLatticesOfLongCells) {
  for (const double up : {0.3, 0.5, 0.7}) {
    for (const double edge : {4.0, 6.0}) {
      const double radius = 16, length = 8 * radius, flat = std::sqrt(1 - up * up);
      const std::array<double, 3> a = {24, 24, 24};
      const std::array<double, 3> b = {a[0] + 0.765 * flat * length, a[1] + 0.644 * flat * length,
                                       a[2] + up * length};
      const auto result = Skeletonize(Capsule(a, b, radius, {1, 1, edge}), {}, {});
      ASSERT_TRUE(result.ok()) << result.status();
      ASSERT_EQ(result->graph.nodes.size(), 2u);
      for (const SkeletonNode& node : result->graph.nodes) {
        const WorldPoint at = result->graph.PositionOf(node.at);
        EXPECT_LT(std::min(Gap(at, a), Gap(at, b)), 0.5 * radius) << up << ' ' << edge;
      }
    }
  }
}

// Slices eight times as thick as voxels are wide, tubes one and a half to two slices thick.
TEST(Tips, OfTubesThroughThickSlicesLieInTheirCaps) {
  const struct {
    WorldPoint a, b;
    double radius;
  } tubes[] = {{{17, 20, 40}, {26, 28, 300}, 14},
               {{22, 21, 60}, {24, 26, 330}, 16},
               {{16, 16, 100}, {33, 32, 130}, 12}};
  for (const auto& [a, b, radius] : tubes) {
    const SkeletonGraph graph = GraphOfVoxels(a, b, radius, 8);
    ASSERT_EQ(graph.nodes.size(), 2u);
    for (const SkeletonNode& node : graph.nodes) {
      const WorldPoint at = graph.PositionOf(node.at);
      EXPECT_LT(std::min(Gap(at, a), Gap(at, b)), 0.75 * radius);
      EXPECT_GT(graph.RadiusOf(node.at), 0.5 * radius);
    }
  }
}

// Near its tips the ridge of the distances falls, up to 1 per unit where it ends.
TEST(Tips, LieWhereTheMedialLineOfASpheroidEnds) {
  const double along = 70, across = 14, reach = along - across * across / along;
  const std::array<double, 3> axis = {0.48, 0.6, 0.64};
  VolumeBuilder builder({64, 64, 64});
  for (Sublattice s : kSublattices) {
    for (int32_t n = 0; n < 64 * 64 * 64; ++n) {
      const LatticePoint p = PointAt(s, n % 64, n / 64 % 64, n / 64 / 64);
      const std::array<double, 3> from = {p.x - 64.0, p.y - 64.0, p.z - 64.0};
      const double t = from[0] * axis[0] + from[1] * axis[1] + from[2] * axis[2];
      const double off = from[0] * from[0] + from[1] * from[1] + from[2] * from[2] - t * t;
      if (t * t / (along * along) + off / (across * across) <= 1) builder.Add(p);
    }
  }
  const auto result = Skeletonize(*std::move(builder).Build(), {}, {});
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_EQ(result->graph.nodes.size(), 2u);
  for (const SkeletonNode& node : result->graph.nodes) {
    const LatticePoint p = node.at.point;
    const double way = p.x < 64 ? -reach : reach;
    EXPECT_LT(
        std::hypot(p.x - 64 - way * axis[0], p.y - 64 - way * axis[1], p.z - 64 - way * axis[2]),
        4);
  }
}

// Takes every tenth or so point off the surface, none of them next to another.
Volume WithPits(const Volume& object, uint32_t seed) {
  VolumeBuilder builder(object.extent(), object.placement());
  std::set<LatticePoint> pits;
  std::mt19937 random(seed);
  object.ForEachPoint([&](LatticePoint p) {
    const auto around = [&](auto holds) {
      return std::ranges::any_of(kDirections14, [&](LatticePoint d) { return holds(p + d); });
    };
    const bool on_surface = around([&](LatticePoint q) { return !object.Contains(q); });
    const bool beside_pit = around([&](LatticePoint q) { return pits.contains(q); });
    if (on_surface && !beside_pit && random() % 8 == 0) {
      pits.insert(p);
    } else {
      builder.Add(p);
    }
  });
  return *std::move(builder).Build();
}

void ExpectTips(const Volume& object, const WorldPoint& a, const WorldPoint& b) {
  const auto result = Skeletonize(object, {}, {});
  ASSERT_TRUE(result.ok()) << result.status();
  const SkeletonGraph& graph = result->graph;
  ASSERT_EQ(graph.nodes.size(), 2u);
  for (const SkeletonNode& node : graph.nodes) {
    const WorldPoint tip = graph.PositionOf(node.at);
    EXPECT_LT(std::min(Gap(tip, a), Gap(tip, b)), 0.5);
  }
}

// Pits make the balls of the limb smaller, but hardly those in its cap, which touch it in few
// places; and thinning may leave the middle line before it ends.
TEST(Tips, DoNotMoveForPitsOfTheSurface) {
  const std::array<double, 3> a = {12, 12, 12}, b = {60, 30, 24};
  for (const double radius : {5.0, 7.0}) {
    const Volume object = Capsule(a, b, radius, {1, 1, 1});
    for (uint32_t seed = 0; seed < 20; ++seed) {
      SCOPED_TRACE(testing::Message() << "radius " << radius << ", seed " << seed);
      ExpectTips(WithPits(object, seed), a, b);
    }
  }
}

// At the end of a thin limb single points stand out that are the limb itself, not noise.
TEST(Tips, OfThinLimbsAreNotTakenForHair) {
  const WorldPoint a = {12, 12, 12}, b = {25, 39, 33};
  for (const double radius : {0.75, 0.8}) {
    const auto result = Skeletonize(Capsule(a, b, radius, {1, 1, 1}), {}, {});
    ASSERT_TRUE(result.ok()) << result.status();
    for (const WorldPoint& tip : {a, b}) {
      double gap = 1000;
      for (const SkeletonNode& node : result->graph.nodes) {
        gap = std::min(gap, Gap(result->graph.PositionOf(node.at), tip));
      }
      EXPECT_LT(gap, 1.5);
    }
  }
}

// Where few points have half of their neighbors, those of the limb's points count instead. Ends lay
// up to 2.3 cells from the tips.
TEST(Tips, OfThinLimbsInAnyDirectionLieAtTheirEnds) {
  constexpr int kLimbs = 60;
  double largest = 0;
  for (int n = 0; n < kLimbs; ++n) {
    const double height = 1 - (n + 0.5) / kLimbs, across = std::sqrt(1 - height * height);
    const double angle = 2.399963 * n;
    const WorldPoint way = {across * std::cos(angle), across * std::sin(angle), height};
    const WorldPoint a = {24 - 18 * way[0], 24 - 18 * way[1], 4.5};
    const WorldPoint b = {24 + 18 * way[0], 24 + 18 * way[1], 4.5 + 36 * way[2]};
    const auto result = Skeletonize(Capsule(a, b, 0.7, {1, 1, 1}), {}, {});
    ASSERT_TRUE(result.ok()) << result.status();
    for (const WorldPoint& tip : {a, b}) {
      double gap = 1000;
      for (const SkeletonNode& node : result->graph.nodes) {
        gap = std::min(gap, Gap(result->graph.PositionOf(node.at), tip));
      }
      largest = std::max(largest, gap);
    }
  }
  EXPECT_LT(largest, 1.2);
}

// The steps of a surface of voxels are twice as high as those of lattice points.
TEST(Tips, OfLimbsOfVoxelsLieNoFartherOutForASteppedSurface) {
  constexpr int kLimbs = 60;
  double sum = 0, largest = 0;
  for (int n = 0; n < kLimbs; ++n) {
    const double height = 1 - (n + 0.5) / kLimbs, across = std::sqrt(1 - height * height);
    const double angle = 2.399963 * n, radius = 1.5 + 1.5 * n / kLimbs;
    const WorldPoint way = {across * std::cos(angle), across * std::sin(angle), height};
    const WorldPoint a = {24 - 18 * way[0], 24 - 18 * way[1], 4.5};
    const WorldPoint b = {24 + 18 * way[0], 24 + 18 * way[1], 4.5 + 36 * way[2]};
    const SkeletonGraph graph = GraphOfVoxels(a, b, radius);
    for (const WorldPoint& tip : {a, b}) {
      double gap = 1000;
      for (const SkeletonNode& node : graph.nodes) {
        gap = std::min(gap, Gap(graph.PositionOf(node.at), tip));
      }
      sum += gap;
      largest = std::max(largest, gap);
    }
  }
  EXPECT_LT(sum / (2 * kLimbs), 0.6);  // voxels
  EXPECT_LT(largest, 1.5);
}

// Along the branch of a leg the distance falls from that of the body to that of the leg.
TEST(Tips, OfAShortLegStayOutsideTheBody) {
  const std::array<double, 3> center = {30, 30, 30}, above = {30, 30, 30.5}, foot = {30, 30, 66};
  const Volume body = Capsule(center, above, 24, {1, 1, 1});
  const Volume leg = Capsule(center, foot, 7, {1, 1, 1});
  VolumeBuilder builder({60, 60, 80});
  body.ForEachPoint([&](LatticePoint p) { builder.Add(p); });
  leg.ForEachPoint([&](LatticePoint p) { builder.Add(p); });
  for (ThinningMethod method : {ThinningMethod::kDirectional, ThinningMethod::kSymmetric}) {
    const auto result =
        Skeletonize(*VolumeBuilder(builder).Build(), {.thinning = {.method = method}}, {});
    ASSERT_TRUE(result.ok()) << result.status();
    double gap = 1000;
    for (const SkeletonNode& node : result->graph.nodes) {
      gap = std::min(gap, Gap(result->graph.PositionOf(node.at), foot));
    }
    EXPECT_LT(gap, 3);
  }
}

// Behind a bead the limb is thin; the bead has a larger distance, but is not its end. Ends lay in
// the bead.
TEST(Tips, OfABeadedLimbLieBehindItsLastBead) {
  const WorldPoint tip = {78, 64, 56}, way = {0.6, 0.64, 0.48};
  const auto back = [&](double by) {
    return WorldPoint{tip[0] - by * way[0], tip[1] - by * way[1], tip[2] - by * way[2]};
  };
  for (const double tail : {18.0, 24.0}) {
    VolumeBuilder builder({90, 90, 90});
    const auto add = [&](const WorldPoint& a, const WorldPoint& b, double radius) {
      Capsule(a, b, radius, {1, 1, 1}).ForEachPoint([&](LatticePoint p) { builder.Add(p); });
    };
    add(back(76), tip, 4);
    for (const double at : {tail, tail + 30}) add(back(at), back(at + 0.5), 12);
    const auto result = Skeletonize(*std::move(builder).Build(), {}, {});
    ASSERT_TRUE(result.ok()) << result.status();
    ASSERT_EQ(result->graph.nodes.size(), 2u);
    for (const SkeletonNode& node : result->graph.nodes) {
      const WorldPoint at = result->graph.PositionOf(node.at);
      EXPECT_LT(std::min(Gap(at, tip), Gap(at, back(76))), 3) << tail;
    }
  }
}

// Seen from the body that it leaves, a limb that turns back ends where it bends.
TEST(Tips, OfABentLimbLieAtItsEnd) {
  VolumeBuilder builder({130, 90, 60});
  const auto add = [&](const WorldPoint& a, const WorldPoint& b, double radius) {
    Capsule(a, b, radius, {1, 1, 1}).ForEachPoint([&](LatticePoint p) { builder.Add(p); });
  };
  WorldPoint last = {100, 30, 26};
  add({26, 30, 26}, {70, 30, 26}, 24);
  add({70, 30, 26}, last, 12);
  for (int part = 1; part <= 12; ++part) {
    const double angle = 3.14159265 * part / 12;
    const WorldPoint next = {100 + 13 * std::sin(angle), 43 - 13 * std::cos(angle), 26};
    add(last, next, 12 - part / 3.0);
    last = next;
  }
  const WorldPoint tip = {98, 56, 26};
  add(last, tip, 8);
  const auto result = Skeletonize(*std::move(builder).Build(), {}, {});
  ASSERT_TRUE(result.ok()) << result.status();
  double gap = 1000;
  for (const SkeletonNode& node : result->graph.nodes) {
    gap = std::min(gap, Gap(result->graph.PositionOf(node.at), tip));
  }
  EXPECT_LT(gap, 8);  // a radius
}

// A leaf 9 units thick on a stalk.
TEST(Tips, OfAPointedFlatLimbLieAtItsPoint) {
  constexpr double kFirst = 40, kLength = 160, kWidth = 40;
  VolumeBuilder builder({105, 50, 14});
  for (int32_t z = 8; z < 17; ++z) {
    for (int32_t y = z % 2; y < 100; y += 2) {
      for (int32_t x = z % 2; x < 210; x += 2) {
        const double part = std::clamp((x - kFirst) / kLength, 0.0, 1.0), across = std::abs(y - 50);
        const double width = kWidth * std::pow(std::sin(3.14159265 * part), 0.8);
        const bool in_stalk = x >= 8 && x < kFirst + 10 && across <= 5;
        if (across < width - 0.5 || in_stalk) builder.Add({x, y, z});
      }
    }
  }
  const auto result = Skeletonize(*std::move(builder).Build(), {}, {});
  ASSERT_TRUE(result.ok()) << result.status();
  int32_t farthest = 0;
  for (const SkeletonNode& node : result->graph.nodes) {
    farthest = std::max(farthest, node.at.point.x);
  }
  EXPECT_GT(farthest, kFirst + kLength - 20);
}

// One cylinder, sampled alike along all axes and five times coarser along z.
TEST(UnequalSpacing, GivesTheSameCenterLineAndRadius) {
  const std::array<double, 3> a = {14, 14, 20}, b = {30, 44, 100};
  const double radius = 8;
  for (const auto& spacing : {std::array{1.0, 1.0, 1.0}, std::array{1.0, 1.0, 5.0}}) {
    // Half the coarsest spacing, and at least what the directional method needs.
    const double tolerance = std::max(spacing[2] / 2, 1.25);
    const Volume object = Capsule(a, b, radius, spacing);
    for (DistanceKind kind :
         {DistanceKind::kChamfer, DistanceKind::kChamferOptimal, DistanceKind::kEuclidean}) {
      SkeletonizeOptions options;
      options.distance = kind;
      const auto result = Skeletonize(object, options, {});
      ASSERT_TRUE(result.ok()) << result.status();
      const SkeletonGraph& graph = result->graph;
      ASSERT_EQ(graph.edges.size(), 1u);
      const double length = Gap(a, b);
      for (const SkeletonPoint& p : graph.points) {
        const WorldPoint at = graph.PositionOf(p);
        double t = 0, squared = 0;
        for (size_t n = 0; n < 3; ++n) t += (at[n] - a[n]) * (b[n] - a[n]) / length;
        if (t < radius || t > length - radius) continue;  // the caps
        for (size_t n = 0; n < 3; ++n) {
          const double off = at[n] - a[n] - t * (b[n] - a[n]) / length;
          squared += off * off;
        }
        EXPECT_LE(std::sqrt(squared), tolerance) << "at " << t;
        EXPECT_NEAR(graph.RadiusOf(p), radius, tolerance) << "at " << t;
      }
    }
  }
}

}  // namespace
}  // namespace bccskel
