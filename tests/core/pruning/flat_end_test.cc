#include "core/pruning/flat_end.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/import/shapes/rasterize.h"
#include "core/import/shapes/solids.h"
#include "core/mask/mask_converter.h"
#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/simple_noise.h"
#include "tests/support/volume_where.h"

namespace bccskel::flat_end {
namespace {

using shapes::Block;
using shapes::Vector;

// Lattice units, half of each.
constexpr double kLength = 120, kWidth = 28, kThickness = 4;

// A strip turned about two axes.
Block Strip(double turn, double thickness = kThickness) {
  const double c = std::cos(turn), s = std::sin(turn);
  return {{kLength, kWidth, thickness}, {c, s * c, s * s}, {-s, c * c, c * s}};
}

Vector Middle(const Volume& object) {
  Vector sum;
  double count = 0;
  object.ForEachPoint([&](LatticePoint p) {
    sum = sum + Vector{double(p.x), double(p.y), double(p.z)};
    ++count;
  });
  return (1 / count) * sum;
}

std::vector<Vector> EndsOf(const Volume& object) {
  const SkeletonizeResult result = *Skeletonize(object, {}, {});
  const Vector middle = Middle(object);
  std::vector<Vector> ends;
  for (const SkeletonNode& node : result.graph.nodes) {
    if (node.kind != NodeKind::kEnd) continue;
    const LatticePoint p = node.at.point;
    ends.push_back(Vector{double(p.x), double(p.y), double(p.z)} - middle);
  }
  return ends;
}

// Half a width away from the rim, as the tip of a round limb is a radius away.
TEST(FlatEnd, LiesInTheMiddleOfAStripInAnyPose) {
  for (const double turn : {0.0, 0.25, 0.5, 1.0}) {
    const Block strip = Strip(turn);
    const Volume clean = *shapes::Rasterize({{strip}}, 1);
    for (const double noise : {0.0, 0.02}) {
      SCOPED_TRACE(testing::Message() << turn << ' ' << noise);
      const std::vector<Vector> ends =
          EndsOf(noise > 0 ? test::WithSimpleNoise(clean, noise, 3) : clean);
      ASSERT_EQ(ends.size(), 2u);
      for (const Vector& end : ends) {
        EXPECT_LT(std::abs(Dot(end, strip.second)), 0.4 * kWidth);
        EXPECT_NEAR(std::abs(Dot(end, strip.first)), kLength - kWidth, 0.4 * kWidth);
      }
    }
  }
}

// Half as thick as wide, or a bit more.
TEST(FlatEnd, LiesInTheMiddleOfAThickBar) {
  for (const double thickness : {14.0, 15.5}) {
    for (const double noise : {0.0, 0.05}) {
      SCOPED_TRACE(testing::Message() << thickness << ' ' << noise);
      const Block bar = Strip(0.5, thickness);
      const Volume clean = *shapes::Rasterize({{bar}}, 1);
      const std::vector<Vector> ends =
          EndsOf(noise > 0 ? test::WithSimpleNoise(clean, noise, 3) : clean);
      ASSERT_EQ(ends.size(), 2u);
      for (const Vector& end : ends) EXPECT_LT(std::abs(Dot(end, bar.second)), 0.4 * kWidth);
    }
  }
}

// A strip bent into an arc: its normal turns by a right angle along the way.
TEST(FlatEnd, LiesInTheMiddleOfABentStrip) {
  const double radius = 140, half_angle = 0.7;
  const Volume bent = test::VolumeWhere({100, 80, 50}, [&](int32_t x, int32_t y, int32_t z) {
    const double u = x - 100, v = y - 20 + radius * std::cos(half_angle);
    return std::abs(std::hypot(u, v) - radius) <= kThickness &&
           std::abs(std::atan2(u, v)) <= half_angle && std::abs(z - 50) <= kWidth;
  });
  const SkeletonizeResult result = *Skeletonize(bent, {}, {});
  int ends = 0;
  for (const SkeletonNode& node : result.graph.nodes) {
    if (node.kind != NodeKind::kEnd) continue;
    ++ends;
    EXPECT_LT(std::abs(node.at.point.z - 50), 0.3 * kWidth);
  }
  EXPECT_EQ(ends, 2);
}

// What is inside by its own coordinates, at most `reach` units from its middle, turned about two
// axes; and the way from its ends to `tip`, the nearest, along a segment from there of length
// `cap`.
struct Turned {
  double turn = 0, reach = 0;
  std::function<bool(Vector)> inside;

  Vector Own(Vector at) const {
    const double c = std::cos(turn), s = std::sin(turn);
    const Vector flat = {c * at.x + s * at.y, -s * at.x + c * at.y, at.z};
    return {flat.x, c * flat.y + s * flat.z, -s * flat.y + c * flat.z};
  }
  Vector FromMiddle(LatticePoint p) const {
    const double middle = std::ceil(reach) + 2;
    return Own({p.x - middle, p.y - middle, p.z - middle});
  }
  Volume Sampled() const {
    const auto cells = static_cast<int32_t>(reach) + 4;
    return test::VolumeWhere({cells, cells, cells}, [&](int32_t x, int32_t y, int32_t z) {
      return inside(FromMiddle({x, y, z}));
    });
  }
  std::vector<Vector> Ends(double noise, uint64_t seed) const {
    const Volume clean = Sampled();
    const SkeletonizeResult result =
        *Skeletonize(noise > 0 ? test::WithSimpleNoise(clean, noise, seed) : clean, {}, {});
    std::vector<Vector> ends;
    for (const SkeletonNode& node : result.graph.nodes) {
      if (node.kind == NodeKind::kEnd) ends.push_back(FromMiddle(node.at.point));
    }
    return ends;
  }
};

// Pressed flat: 2 * `half` thick where the rim is `width` away, sharp at the rim.
bool IsThick(double rim_way, double width, double half, double z) {
  if (rim_way < 0) return false;
  const double in = 1 - std::min(rim_way / width, 1.0);
  return std::abs(z) <= half * std::sqrt(1 - in * in);
}

// Six times as wide as thick, round at the ends, bent in its own plane. Noise on its rim led the
// curve out of the middle long before the end.
TEST(FlatEnd, LiesInTheMiddleOfALimbBentInItsPlane) {
  static constexpr double kHalf = 28, kBend = 220, kAngle = 0.45;  // to either side
  for (const double turn : {0.2, 0.5, 0.9}) {
    const Turned limb = {turn, 150, [](Vector at) {
                           if (std::abs(at.z) > kHalf / 6) return false;
                           const double y = at.y - kBend, angle = std::atan2(at.x, -y);
                           const double held = std::clamp(angle, -kAngle, kAngle);
                           const double off = std::hypot(at.x - kBend * std::sin(held),
                                                         y + kBend * std::cos(held));
                           return IsThick(kHalf - off, kHalf, kHalf / 6, at.z);
                         }};
    for (const uint64_t seed : {1u, 2u, 3u}) {
      SCOPED_TRACE(testing::Message() << turn << ' ' << seed);
      const std::vector<Vector> ends = limb.Ends(0.05, seed);
      ASSERT_EQ(ends.size(), 2u);
      for (const Vector& end : ends) {
        const double y = end.y - kBend, angle = std::abs(std::atan2(end.x, -y));
        EXPECT_LT(std::abs(std::hypot(end.x, y) - kBend), 5);  // off its line
        EXPECT_GT(angle, kAngle - 5 / kBend);
        EXPECT_LT(angle, kAngle + kHalf / kBend);
      }
    }
  }
}

// On a stalk; `slope` is the sine of half the angle at its point, `flatness` its width by its
// thickness.
struct BroadLeaf {
  static constexpr double kHalf = 56, kPoint = 6;
  double slope, flatness;

  double Length() const { return (kHalf - kPoint) / slope; }
  bool Contains(Vector at) const {
    if (std::abs(at.z) > kHalf / flatness) return false;
    const double x = at.x + 20, y = std::abs(at.y);
    const double along = std::clamp(x - y * slope / std::sqrt(1 - slope * slope), 0.0, Length());
    const double width = kHalf - slope * along;
    const bool stalk = x < 0 && x > -80 && std::hypot(y, at.z) < 9;
    return stalk || IsThick(width - std::hypot(x - along, y), width, width / flatness, at.z);
  }
  void CheckEnds(double turn, double noise, uint64_t seed) const {
    SCOPED_TRACE(testing::Message() << turn << ' ' << noise);
    const Turned leaf = {turn, 130, [&](Vector at) { return Contains(at); }};
    const std::vector<Vector> ends = leaf.Ends(noise, seed);
    ASSERT_EQ(ends.size(), 2u);
    const Vector end = std::ranges::max(ends, {}, &Vector::x);
    EXPECT_GT(end.x, Length() - 20 - 6);
    EXPECT_LT(std::abs(end.y), 5);
  }
};

// Its sides meet at 74 degrees, so W falls nearly as fast as the way grows.
TEST(FlatEnd, LiesAtThePointOfABroadLeaf) {
  for (const double turn : {0.2, 0.5, 0.9}) {
    BroadLeaf{.slope = 0.6, .flatness = 4}.CheckEnds(turn, 0, 1);
    BroadLeaf{.slope = 0.6, .flatness = 4}.CheckEnds(turn, 0.05, 1);
  }
}

// Noise led the walk out of the middle, and it went on to the rim.
TEST(FlatEnd, ReturnsToTheMiddleOfALeafThatTheWalkHasLeft) {
  BroadLeaf{.slope = 0.55, .flatness = 6}.CheckEnds(1.1, 0.1, 2);
}

// A strip 1.8 to 3 times as long as wide. Where its curve forked, how many of the four corners had
// ends depended on the pose.
TEST(FlatEnd, HasNoneInTheCornersOfAStrip) {
  for (const double width : {40.0, 56.0, 66.0}) {
    for (const double turn : {0.0, 0.2, 0.5, 1.0, 1.3}) {
      SCOPED_TRACE(testing::Message() << width << ' ' << turn);
      const double c = std::cos(turn), s = std::sin(turn);
      const Block strip = {{kLength, width, kThickness}, {c, s * c, s * s}, {-s, c * c, c * s}};
      const std::vector<Vector> ends = EndsOf(*shapes::Rasterize({{strip}}, 1));
      ASSERT_EQ(ends.size(), 2u);
      for (const Vector& end : ends) EXPECT_LT(std::abs(Dot(end, {-s, c * c, c * s})), width / 2);
    }
  }
}

// Its half is too short to show the way of its curve, which leads from corner to corner.
TEST(FlatEnd, LiesInTheMiddleOfAShortStrip) {
  constexpr double kHalfWidth = 58, kHalfThick = 10;
  for (const double turn : {0.0, 0.2, 0.3, 0.5, 0.7, 0.9, 1.1, 1.3, 1.5}) {
    SCOPED_TRACE(turn);
    const double c = std::cos(turn), s = std::sin(turn);
    const Vector across = {-s, c * c, c * s};
    const Block strip = {{1.6 * kHalfWidth, kHalfWidth, kHalfThick}, {c, s * c, s * s}, across};
    const std::vector<Vector> ends = EndsOf(*shapes::Rasterize({{strip}}, 1));
    ASSERT_EQ(ends.size(), 2u);
    for (const Vector& end : ends) EXPECT_LT(std::abs(Dot(end, across)), 0.4 * kHalfWidth);
  }
}

// Its corners end no limbs.
TEST(FlatEnd, LeavesThePlateItsCorners) {
  const Block plate = {{60, 60, kThickness}, {0.8, 0.6, 0}, {-0.6, 0.8, 0}};
  const std::vector<Vector> ends = EndsOf(*shapes::Rasterize({{plate}}, 1));
  EXPECT_EQ(ends.size(), 4u);
  for (const Vector& end : ends) EXPECT_GT(Length(end), 65);
}

// A tooth on a bar, whose noise makes it begin late. Ends lay in its corners.
TEST(FlatEnd, LiesInTheMiddleOfAShortTooth) {
  const struct {
    double width, turn;
    uint64_t seed;
  } teeth[] = {{15, 0.62, 1}, {15, 0.88, 3}, {15, 1.01, 3}, {24, 1.53, 3}};
  for (const auto& [width, turn, seed] : teeth) {
    const Turned bar = {
        .turn = turn, .reach = 5 * width, .inside = [width = width](Vector at) {
          const bool in_tooth = at.x >= 0 && at.x <= 2.6 * width && std::abs(at.z) <= width &&
                                std::abs(at.y) <= 0.4 * width;
          return in_tooth || (std::hypot(at.x, at.z) <= width && std::abs(at.y) <= 4.6 * width);
        }};
    int found = 0;
    for (const Vector& end : bar.Ends(0.05, seed)) {
      if (end.x <= 1.1 * width) continue;
      ++found;
      EXPECT_LT(std::abs(end.z), 0.4 * width) << turn;
    }
    EXPECT_EQ(found, 1) << turn;
  }
}

// A ball that an error of units has turned into a disk a million times as wide as thick.
TEST(FlatEnd, IsFoundInBoundedTimeWhateverTheSpacings) {
  constexpr int32_t kEdge = 40;
  const MaskGrid grid = {kEdge, kEdge, kEdge, {.spacing = {1e-6, 1, 1}}};
  absl::StatusOr<MaskConverter> converter = MaskConverter::Create(grid, {});
  ASSERT_TRUE(converter.ok()) << converter.status();
  for (int32_t z = 0; z < kEdge; ++z) {
    std::vector<uint64_t> words(kEdge);
    for (int32_t n = 0; n < kEdge * kEdge; ++n) {
      const int32_t x = n % kEdge, y = n / kEdge;
      const bool inside = std::hypot(x - 19.5, y - 19.5, z - 19.5) < 18;
      words[static_cast<size_t>(y)] |= uint64_t{inside} << x;
    }
    ASSERT_TRUE(converter->AddSlice(words, {}).ok());
  }
  const absl::StatusOr<ConvertedMask> mask = std::move(*converter).Finish();
  ASSERT_TRUE(mask.ok()) << mask.status();
  const SkeletonizeOptions options = {.source = ObjectSource::kVoxels,
                                      .voxel_slabs = SlabsOf(grid, VoxelPoints::kTwo)};
  // With steps of a unit it would take hours.
  exec::Context context;
  context.deadline = exec::Context::Clock::now() + std::chrono::minutes(1);
  const auto result = Skeletonize(mask->volume, options, context);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_TRUE(result->certificate.TopologyKept());
}

}  // namespace
}  // namespace bccskel::flat_end
