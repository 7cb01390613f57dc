#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/pipeline/skeletonize.h"
#include "core/pipeline/skeletonize_within.h"
#include "tests/core/pipeline/skeleton_of.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

using test::SkeletonOf, test::VolumeWhere;

SkeletonizeOptions Continued(SkeletonizeOptions options = {}) {
  options.border = Border::kContinues;
  return options;
}

Volume CroppedBlob(uint64_t seed) {
  const Volume blob = VolumeOfPoints(test::RandomBlob(seed, {40, 40, 40}, 10, 14));
  return VolumeWhere({21, 18, 19}, [&](double x, double y, double z) {
    return blob.Contains(
        {static_cast<int32_t>(x) + 20, static_cast<int32_t>(y) + 20, static_cast<int32_t>(z) + 20});
  });
}

// Along (3, 1, 0) / sqrt(10) through the middle.
bool IsInRod(double x, double y, double z, double radius) {
  const double dx = x - 64, dy = y - 32, dz = z - 32;
  const double along = (3 * dx + dy) / std::sqrt(10);
  return dx * dx + dy * dy + dz * dz - along * along <= radius * radius;
}

TEST(Border, ARodThatIsCutOffRunsStraightToIt) {
  for (const double radius : {4.0, 9.0, 14.0}) {
    const Volume rod = VolumeWhere(
        {64, 32, 32}, [radius](double x, double y, double z) { return IsInRod(x, y, z, radius); });
    const SkeletonizeResult result = SkeletonOf(rod, Continued());
    ASSERT_EQ(result.graph.edges.size(), 1u) << radius;
    ASSERT_EQ(result.graph.nodes.size(), 2u) << radius;
    for (const SkeletonNode& node : result.graph.nodes) {
      const LatticePoint p = node.at.point;
      EXPECT_TRUE(p.x <= 1 || p.x >= 126) << radius << ": " << p.x;
      EXPECT_NEAR(node.at.radius, radius, 1.5);
    }
    for (const SkeletonPoint& p : result.graph.points) {
      EXPECT_TRUE(IsInRod(p.point.x, p.point.y, p.point.z, 2.5)) << radius;
    }
    // As a limb that ends it stops about a radius before.
    for (const SkeletonNode& node : SkeletonOf(rod, {}).graph.nodes) {
      const int32_t x = node.at.point.x;
      EXPECT_GT(std::min(x, 127 - x), 0.6 * radius) << radius;
    }
  }
}

// Ellipses and bars across the same way: the middle of their cut is that of the limb, however wide
// they are, and no curve leads into a corner of it.
TEST(Border, AFlatLimbThatIsCutOffRunsStraightToItAsOneCurve) {
  for (const double roll : {0.0, 0.6, 1.2}) {
    for (const double width : {16.0, 24.0, 30.0}) {
      for (const bool bar : {false, true}) {
        const auto is_in = [&](double x, double y, double z, double wide, double thick) {
          const double dx = x - 64, dy = y - 64, dz = z - 32;
          const double aside = (3 * dy - dx) / std::sqrt(10);
          const double u = (std::cos(roll) * aside + std::sin(roll) * dz) / wide;
          const double v = (std::cos(roll) * dz - std::sin(roll) * aside) / thick;
          return bar ? std::max(std::abs(u), std::abs(v)) <= 1 : u * u + v * v <= 1;
        };
        const Volume limb = VolumeWhere(
            {64, 64, 32}, [&](double x, double y, double z) { return is_in(x, y, z, width, 7); });
        const SkeletonizeResult result = SkeletonOf(limb, Continued());
        ASSERT_EQ(result.graph.edges.size(), 1u) << roll << " " << width << " " << bar;
        for (const SkeletonNode& node : result.graph.nodes) {
          const LatticePoint p = node.at.point;
          EXPECT_TRUE(p.x <= 1 || p.x >= 126) << roll << " " << width << " " << bar << ": " << p.x;
          EXPECT_TRUE(is_in(p.x, p.y, p.z, width / 4, 4)) << roll << " " << width << " " << bar;
        }
      }
    }
  }
}

// Limbs that run along the border, bodies that touch it and two limbs that touch there.
TEST(Border, OnlyCutsAcrossALimbLeadACurveToTheBorder) {
  const auto ends_of = [](const auto& is_in) {
    const SkeletonizeResult result = SkeletonOf(VolumeWhere({48, 32, 32}, is_in), Continued());
    return std::ranges::count(result.graph.nodes, NodeKind::kEnd, &SkeletonNode::kind);
  };
  EXPECT_EQ(ends_of([](double x, double y, double z) {
              return std::hypot(std::max(std::abs(x - 48) - 30, 0.0), y - 32, z) <= 8;
            }),
            2);
  EXPECT_EQ(ends_of([](double x, double y, double z) {  // a ball and its spine
              return std::hypot(x - 16, y - 32, z - 32) <= 19 ||
                     (x > 16 && x < 70 && std::hypot(y - 32, z - 32) <= 6);
            }),
            2);
  EXPECT_EQ(ends_of([](double x, double y, double z) {  // a V
              const double beside = std::abs(y - 32) - (10 + 0.04 * x);
              return x < 80 && std::hypot(beside, z - 32) <= 11;
            }),
            4);
}

// Two crossed bars, cut out of a stack of this height: limbs stay, however thin the stack is.
TEST(Border, ARodInOneLayerKeepsItsEnds) {
  for (const double radius : {4.0, 6.0, 9.0}) {
    const Volume rod = VolumeWhere({240, 90, 1}, [radius](double x, double y, double) {
      const double dx = x - 240, dy = y - 90;
      const double along = std::clamp((3 * dx + dy) / std::sqrt(10), -220.0, 220.0);
      return std::hypot(dx - 3 * along / std::sqrt(10), dy - along / std::sqrt(10)) <= radius;
    });
    const SkeletonizeResult result = SkeletonOf(rod, Continued());
    ASSERT_EQ(result.graph.nodes.size(), 2u) << radius;
    for (const SkeletonNode& node : result.graph.nodes) {
      const LatticePoint p = node.at.point;
      EXPECT_NEAR(std::hypot(p.x - 240, p.y - 90), 220, 4) << radius;
    }
  }
}

TEST(Border, LimbsInAThinStackKeepTheirCurvesAndRadii) {
  for (const int32_t height : {1, 3, 10}) {
    const Volume cross = VolumeWhere({64, 64, height}, [](double x, double y, double /*z*/) {
      const double across = std::min(std::abs(x - 60), std::abs(y - 66));
      return across <= 7 && std::max(std::abs(x - 60), std::abs(y - 66)) <= 50;
    });
    const SkeletonizeResult result = SkeletonOf(cross, Continued());
    EXPECT_EQ(std::ranges::count(result.graph.nodes, NodeKind::kEnd, &SkeletonNode::kind), 4)
        << height;
    double deepest = 0;
    for (const SkeletonNode& node : result.graph.nodes) {
      deepest = std::max<double>(deepest, node.at.radius);
    }
    EXPECT_NEAR(deepest, 7 * std::numbers::sqrt2, 2) << height;
  }
}

// To the nearest background point of the extent, by looking at all.
double DepthOf(LatticePoint p, const Volume& object) {
  double least = std::numeric_limits<double>::infinity();
  test::ForEachPointOf(object.extent(), [&](int32_t x, int32_t y, int32_t z) {
    if (object.Contains({x, y, z})) return;
    least = std::min(least, std::hypot(x - p.x, y - p.y, z - p.z));
  });
  return least;
}

TEST(BorderLaw, DistancesKnowNoBackgroundBeyond) {
  for (uint64_t seed = 0; seed < 8; ++seed) {
    const Volume object = CroppedBlob(seed);
    for (const DistanceKind kind : {DistanceKind::kEuclidean, DistanceKind::kChamfer}) {
      const SkeletonizeResult result = SkeletonOf(object, Continued({.distance = kind}));
      ASSERT_GT(result.skeleton_points, 0u);
      for (const SkeletonNode& node : result.graph.nodes) {
        EXPECT_NEAR(node.at.radius, DepthOf(node.at.point, object), 1e-4) << seed;
      }
    }
  }
}

TEST(BorderLaw, KeepsTopologyAndStaysInTheObject) {
  for (uint64_t seed = 0; seed < 12; ++seed) {
    const Volume object = CroppedBlob(seed);
    for (const ThinningMethod method : {ThinningMethod::kSymmetric, ThinningMethod::kDirectional}) {
      const SkeletonizeOptions options = Continued({.thinning = {.method = method}});
      const SkeletonizeResult result = SkeletonOf(object, options);
      EXPECT_TRUE(result.certificate.TopologyKept()) << seed;
      EXPECT_EQ(result.certificate.simple_points_left, 0u) << seed;
      EXPECT_EQ(result.thin.extent(), object.extent());
      result.thin.ForEachPoint([&](LatticePoint p) { ASSERT_TRUE(object.Contains(p)) << seed; });
      for (const SkeletonPoint& p : result.graph.points) {
        ASSERT_TRUE(result.thin.Contains(p.point)) << seed;
      }
      EXPECT_EQ(result.sha256, SkeletonOf(object, options, 3).sha256) << seed;
    }
  }
}

TEST(BorderLaw, SaysWhichPointsGoWhereTheyAre) {
  const Volume object = CroppedBlob(5);
  SkeletonizeOptions options = Continued();
  options.thinning.keep = {object.SortedPoints().front()};
  VolumeBuilder all(object.extent(), object.placement());
  const auto result = Skeletonize(object, options, {}, [&](int32_t, const Volume& points) {
    points.ForEachPoint([&](LatticePoint p) { all.Add(p); });
  });
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_TRUE(result->thin.Contains(options.thinning.keep.front()));
  result->thin.ForEachPoint([&](LatticePoint p) { all.Add(p); });
  EXPECT_TRUE(*std::move(all).Build() == object);
}

TEST(Border, OfAnObjectThatDoesNotTouchItIsNothing) {
  const auto blob = test::RandomBlob(3, {30, 30, 30}, 8, 10);
  const Volume object = test::VolumeWith(test::Translated(blob, {40, 40, 40}), {80, 80, 80});
  EXPECT_EQ(SkeletonOf(object, Continued()).sha256, SkeletonOf(object, {}).sha256);
}

TEST(Border, OfAnObjectWithoutBackgroundLeavesOnePoint) {
  const Volume full = test::FullVolume({20, 9, 11});
  const SkeletonizeResult result = SkeletonOf(full, Continued());
  EXPECT_TRUE(result.certificate.TopologyKept());
  EXPECT_EQ(result.certificate.skeleton.components, 1);
  EXPECT_EQ(SkeletonOf(Volume(), Continued()).skeleton_points, 0u);
}

// Allows a job so many bytes.
class Allowance final : public exec::MemoryBudget {
 public:
  explicit Allowance(uint64_t bytes) : left_(bytes) {}
  absl::Status Take(uint64_t bytes, const std::string& what_for) override {
    if (bytes > left_) return absl::ResourceExhaustedError(what_for);
    left_ -= bytes;
    return absl::OkStatus();
  }
  void GiveBack(uint64_t bytes) override { left_ += bytes; }

 private:
  uint64_t left_;
};

absl::Status StatusWithin(uint64_t bytes, const Volume& object) {
  test::TeamContext context(1);
  Allowance memory(bytes);
  return SkeletonizeWithin(memory, object, Continued(), context).status();
}

// As far out as it is long there are some 10^12 points on all sides.
TEST(Border, OfALongObjectWithoutBackgroundTakesLittleMemory) {
  const Volume row = test::FullVolume({4000, 2, 2});
  EXPECT_EQ(StatusWithin(256 << 20, row), absl::OkStatus());
  const Volume corners = VolumeWhere(
      {4001, 2, 2}, [](double x, double y, double z) { return x <= 8000 && y <= 2 && z <= 2; });
  SkeletonizeOptions options = Continued();
  options.source = ObjectSource::kVoxels;
  EXPECT_TRUE(SkeletonOf(corners, options).certificate.TopologyKept());
}

// The points beyond its sides, as far out as the farthest point is deep, take gigabytes.
TEST(Border, WithBackgroundFarAwayTakesLittleMemory) {
  const Volume row = VolumeWhere({4000, 2, 2}, [](double x, double, double) { return x > 0; });
  EXPECT_EQ(StatusWithin(64 << 20, row), absl::OkStatus());
  const SkeletonizeResult result = SkeletonOf(row, Continued());
  EXPECT_TRUE(result.certificate.TopologyKept());
  for (const SkeletonNode& node : result.graph.nodes) {
    EXPECT_NEAR(node.at.radius, DepthOf(node.at.point, row), 1e-3);
  }
  const Volume disc = VolumeWhere(
      {160, 160, 1}, [](double x, double y, double) { return std::hypot(x - 160, y - 160) < 150; });
  EXPECT_EQ(StatusWithin(64 << 20, disc), absl::OkStatus());
}

TEST(Border, OverTheLimitOfMemoryIsAnError) {
  const Volume row = VolumeWhere({4000, 2, 2}, [](double x, double, double) { return x > 0; });
  const absl::Status status = StatusWithin(4 << 20, row);
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted) << status;
}

TEST(Border, MayBeThatOfTheLongestAxis) {
  VolumeBuilder builder({kMaxExtentCells, 8, 8});
  for (int32_t x = 0; x < 40; x += 2) builder.Add({2 * kMaxExtentCells - 40 + x, 4, 4});
  const SkeletonizeResult result = SkeletonOf(*std::move(builder).Build(), Continued());
  EXPECT_TRUE(result.certificate.TopologyKept());
  EXPECT_GT(result.skeleton_points, 15u);
}

}  // namespace
}  // namespace bccskel
