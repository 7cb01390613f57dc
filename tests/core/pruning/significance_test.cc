#include "core/pruning/significance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "core/import/shapes/rasterize.h"
#include "core/import/shapes/shapes.h"
#include "core/import/shapes/solids.h"
#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/raw_curves.h"
#include "tests/core/pruning/simple_noise.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

using test::EndsOf;
using test::RawCurves;

// A ball with six spines as long as `length` says, in radii of the ball.
Volume Spiny(double radius, double spine, double length) {
  using shapes::RoundCone;
  std::vector<shapes::Solid> solids = {shapes::Spheroid{{}, {1, 0, 0}, radius, radius}};
  for (const double side : {-1.0, 1.0}) {
    const double tip = side * (radius * (1 + length) - spine);
    for (const shapes::Vector& to :
         {shapes::Vector{tip, 0.1 * tip, 0}, {0, tip, 0.1 * tip}, {0.1 * tip, 0, tip}}) {
      solids.push_back(RoundCone{{}, to, spine, spine});
    }
  }
  return *shapes::Rasterize(solids, 1);
}

// They stick out by less than the body's radius, however far the junction lies inside.
TEST(Significance, KeepsThinSpinesOfAThickBody) {
  for (const double size : {1.0, 2.0}) {
    for (const double length : {0.4, 0.8, 1.2}) {
      SCOPED_TRACE(testing::Message() << size << ' ' << length);
      EXPECT_EQ(EndsOf(Spiny(36 * size, 3 * size, length)), 6u);
    }
  }
}

TEST(Significance, KeepsThinSpinesWhereTheSurfaceIsRough) {
  const Volume rough = test::WithSimpleNoise(Spiny(36, 4, 0.6), 0.1, 3);
  EXPECT_EQ(EndsOf(rough), 6u);
}

// Horns a few units thick, which noise of the surface could be.
TEST(Significance, KeepsSmallLimbsWhereTheSurfaceIsSmooth) {
  const Volume smooth = Spiny(36, 5, 0.28);
  EXPECT_EQ(EndsOf(smooth), 6u);
}

// A ball beside a tube, like an aneurysm of a vessel; lengths in radii of the tube, `off` from its
// axis to the center of the ball.
Volume TubeWithBulge(double radius, double bulge, double off, const shapes::Vector& side) {
  const shapes::Vector end = {0, 0, 8 * radius}, other_end = {0, 0, -8 * radius};
  const double way = off * radius;
  const shapes::Vector middle = {way * side.x, way * side.y, way * side.z};
  const std::vector<shapes::Solid> solids = {
      shapes::RoundCone{end, other_end, radius, radius},
      shapes::Spheroid{middle, {1, 0, 0}, bulge * radius, bulge * radius}};
  return *shapes::Rasterize(solids, 1);
}

// Most of its branch runs through the tube.
TEST(Significance, KeepsBulgesThickerThanTheirLimb) {
  for (const double radius : {8.0, 14.0}) {
    for (const shapes::Vector& side : {shapes::Vector{1, 0, 0}, {0.6, 0.8, 0}}) {
      SCOPED_TRACE(testing::Message() << radius << ' ' << side.y);
      EXPECT_EQ(EndsOf(TubeWithBulge(radius, 1.4, 1.75, side)), 3u);
      EXPECT_EQ(EndsOf(TubeWithBulge(radius, 1.25, 0.4, side)), 2u);
    }
  }
}

// A pore between eight grains, which the border of the image cuts off at its six throats.
TEST(Significance, KeepsLimbsThatTheBorderCutsOffAtTheirNarrowest) {
  constexpr int32_t kSide = 43, kGrain = 25;  // lattice units
  const Volume pore = test::VolumeWhere({22, 22, 22}, [](int32_t x, int32_t y, int32_t z) {
    const int32_t dx = std::min(x, kSide - x), dy = std::min(y, kSide - y);
    const int32_t dz = std::min(z, kSide - z);
    return dx * dx + dy * dy + dz * dz > kGrain * kGrain;
  });
  const SkeletonizeOptions options = {.border = Border::kContinues};
  const SkeletonGraph graph = Skeletonize(pore, options, {})->graph;
  EXPECT_EQ(std::ranges::count(graph.nodes, NodeKind::kEnd, &SkeletonNode::kind), 6);
}

// However wide it is by what lies within the image.
TEST(Significance, KeepsALimbThatCrossesTheImage) {
  for (const int32_t radius : {8, 20, 40}) {
    SCOPED_TRACE(radius);
    const Volume disk = test::VolumeWhere({50, 50, 4}, [&](int32_t x, int32_t y, int32_t /*z*/) {
      return (x - 50) * (x - 50) + (y - 50) * (y - 50) < radius * radius;
    });
    const SkeletonizeOptions options = {.border = Border::kContinues};
    const SkeletonGraph graph = Skeletonize(disk, options, {})->graph;
    ASSERT_EQ(graph.edges.size(), 1u);
    EXPECT_GE(std::abs(graph.nodes[1].at.point.z - graph.nodes[0].at.point.z), 6);
  }
}

// A bar of 16 by 16 lattice units with five teeth on one side, as wide as it is, 8 thick and
// `height` high.
Volume Rack(int32_t height) {
  constexpr int32_t kLength = 240, kWidth = 16, kPitch = 30, kFirst = 60;
  const LatticeExtent extent = {kLength / 2, (kWidth + height) / 2, kWidth / 2};
  return test::VolumeWhere(extent, [](int32_t x, int32_t y, int32_t /*z*/) {
    const int32_t tooth = (x - kFirst + kPitch / 2) / kPitch, middle = kFirst + kPitch * tooth;
    return y < kWidth || (std::abs(x - middle) <= 4 && tooth < 5);
  });
}

// Noise is short for teeth of any thickness: it does not count against them by its full length.
TEST(Significance, KeepsTeethWhereTheSurfaceIsRough) {
  for (const uint64_t seed : {1u, 2u, 3u}) {
    for (const int32_t height : {20, 22}) {
      EXPECT_EQ(EndsOf(test::WithSimpleNoise(Rack(height), 0.05, seed)), 7u);
    }
  }
}

// Which voxels of a mask belong to the object.
class Voxels {
 public:
  Voxels(int32_t x, int32_t y, int32_t z) : size_{x, y, z}, set_(Count(size_)) {}

  void AddBox(const LatticePoint& first, const LatticePoint& last) {
    for (int32_t z = first.z; z <= last.z; ++z) {
      for (int32_t y = first.y; y <= last.y; ++y) {
        for (int32_t x = first.x; x <= last.x; ++x) set_[At(x, y, z)] = true;
      }
    }
  }

  // About `fraction` of the voxels on either side of flat faces change sides, each where its
  // surroundings are flat at its turn.
  void Roughen(double fraction, uint64_t seed) {
    std::mt19937_64 random(seed);
    for (int32_t z = 1; z < size_.z - 1; ++z) {
      for (int32_t y = 1; y < size_.y - 1; ++y) {
        for (int32_t x = 1; x < size_.x - 1; ++x) {
          const bool chosen = static_cast<double>(random() >> 11) * 0x1p-53 < fraction;
          const int around = CountAround(x, y, z);
          if (chosen && (around == 9 || around == 18)) set_[At(x, y, z)].flip();
        }
      }
    }
  }

  // At two points a voxel.
  int64_t Ends() const {
    VolumeBuilder builder({size_.x, size_.y, size_.z});
    for (int32_t z = 0; z < size_.z; ++z) {
      for (int32_t y = 0; y < size_.y; ++y) {
        for (int32_t x = 0; x < size_.x; ++x) {
          if (!set_[At(x, y, z)]) continue;
          builder.Add({2 * x, 2 * y, 2 * z});
          builder.Add({2 * x + 1, 2 * y + 1, 2 * z + 1});
        }
      }
    }
    const SkeletonizeOptions options = {.source = ObjectSource::kVoxels};
    const SkeletonizeResult result = *Skeletonize(*std::move(builder).Build(), options, {});
    return std::ranges::count(result.graph.nodes, NodeKind::kEnd, &SkeletonNode::kind);
  }

 private:
  static size_t Count(const LatticePoint& size) {
    return static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * static_cast<size_t>(size.z);
  }
  size_t At(int32_t x, int32_t y, int32_t z) const {
    return static_cast<size_t>((z * size_.y + y) * size_.x + x);
  }
  int CountAround(int32_t x, int32_t y, int32_t z) const {
    int count = 0;
    for (int32_t dz = -1; dz <= 1; ++dz) {
      for (int32_t dy = -1; dy <= 1; ++dy) {
        for (int32_t dx = -1; dx <= 1; ++dx) count += set_[At(x + dx, y + dy, z + dz)] ? 1 : 0;
      }
    }
    return count;
  }

  LatticePoint size_;
  std::vector<bool> set_;
};

// A bar of 8 by 8 voxels with five teeth, 6 voxels thick and `height` high.
Voxels RackOfVoxels(int32_t height) {
  Voxels rack(130, 16 + height, 16);
  rack.AddBox({4, 4, 4}, {125, 11, 11});
  for (int32_t x = 25; x <= 105; x += 20) rack.AddBox({x - 3, 12, 4}, {x + 2, 11 + height, 11});
  return rack;
}

// What noise does to the radius of a limb is a pit; rows of bumps are thin.
TEST(Significance, KeepsThickTeethOfRoughVoxels) {
  int64_t lost = 0;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    for (const int32_t height : {9, 10, 11}) {
      Voxels rack = RackOfVoxels(height);
      rack.Roughen(0.1, seed);
      lost += 7 - rack.Ends();
    }
  }
  EXPECT_GE(lost, 0);
  EXPECT_LE(lost, 6);  // of 120
}

TEST(Significance, RemovesRowsOfBumpsOfRoughVoxels) {
  for (const uint64_t seed : {1u, 2u, 3u}) {
    Voxels bar(130, 16, 16);
    bar.AddBox({4, 4, 4}, {125, 7, 7});
    bar.Roughen(0.2, seed);
    for (int32_t x = 20; x <= 110; x += 15) bar.AddBox({x, 8, 5}, {x, 11, 5});
    EXPECT_EQ(bar.Ends(), 2) << seed;
  }
}

TEST(Significance, OfLimbsIsTheSameAtAnyResolution) {
  const auto levels_of = [](uint64_t points) {
    const Volume horse = *GenerateShape(Shape::kHorse, {.points = points});
    std::vector<double> levels;
    const SkeletonizeResult result = *Skeletonize(horse, {}, {});
    for (const SkeletonEdge& edge : result.graph.edges) levels.push_back(edge.pruning_level);
    std::ranges::sort(levels, std::greater());
    return levels;
  };
  const std::vector<double> coarse = levels_of(100'000), fine = levels_of(800'000);
  ASSERT_EQ(coarse.size(), fine.size());
  for (size_t n = 0; n < coarse.size(); ++n) {
    if (!std::isfinite(coarse[n])) continue;
    EXPECT_NEAR(coarse[n] / fine[n], 1, 0.25);
  }
}

// A trunk along x and a branch that leaves it and runs along beside it, `apart` from it, all with
// the same radius.
double StrandBeside(int32_t apart) {
  const LatticeExtent extent = {110, 60, 60};
  VolumeBuilder thin(extent);
  for (int32_t x = 10; x <= 200; x += 2) thin.Add({x, 40, 60});
  for (int32_t y = 42; y < 40 + apart; y += 2) thin.Add({40, y, 60});
  for (int32_t x = 40; x <= 190; x += 2) thin.Add({x, 40 + apart, 60});
  const Volume solid = test::VolumeWhere(extent, [](auto...) { return true; });
  const Volume curves = *std::move(thin).Build();
  const std::vector<float> radii(curves.PointCount(), 10.0f);
  const ThinSet set({curves, radii});
  return Significance(solid, {.thin = 3, .thick = 3})
      .Of(set, BranchFrom(set, {190, 40 + apart, 60}));
}

// A slab, 200 wide and 40 thick, and a round limb of radius 10 that leaves its narrow side. The
// branch comes from a trunk in the slab's middle line and ends `out` beyond the slab.
double LimbOfASlab(int32_t out) {
  constexpr int32_t kSide = 100, kMiddle = 100, kRadius = 10, kDepth = 20;
  const LatticeExtent extent = {kSide, 110, 30};
  const int32_t end = kSide + out;
  const Volume solid = test::VolumeWhere(extent, [end](int32_t x, int32_t y, int32_t z) {
    const bool in_limb = std::hypot(y - kMiddle, z - kDepth) <= kRadius;
    return z <= 2 * kDepth && y <= 2 * kMiddle && (x <= kSide || (in_limb && x <= end + kRadius));
  });
  VolumeBuilder thin(extent);
  for (int32_t y = 40; y <= 160; y += 2) thin.Add({26, y, kDepth});
  for (int32_t x = 28; x <= end; x += 2) thin.Add({x, kMiddle, kDepth});
  const Volume curves = *std::move(thin).Build();
  std::vector<float> radii;
  curves.ForEachPoint([&](LatticePoint p) {
    radii.push_back(static_cast<float>(std::clamp(kSide + kRadius - p.x, kRadius, kDepth)));
  });
  const ThinSet set({curves, radii});
  return Significance(solid, {.thin = 1, .thick = 1})
      .Of(set, BranchFrom(set, {end, kMiddle, kDepth}));
}

// Most of the branch's run lies in the slab, whose width is not the limb's.
TEST(Significance, OfALimbThatBeginsLateIsItsOwn) {
  EXPECT_GT(LimbOfASlab(18), 0.6);
  EXPECT_LT(LimbOfASlab(4), 0.4);  // a bump
}

// A body along y, a thick head along x that tapers from 50 to 30 units, and on it an ear as wide as
// the head and 8 units thick. The branch comes from a trunk in the body and ends in the middle of
// the head or leads on into the ear.
double Head(bool into_ear) {
  static constexpr int32_t kBody = 60, kHead = 150, kY = 100, kZ = 60;
  const Volume solid = test::VolumeWhere({100, 90, 60}, [](int32_t x, int32_t y, int32_t z) {
    const double across = std::hypot(y - kY, z - kZ), along = std::clamp(x, kBody, kHead) - kBody;
    const bool in_ear = std::abs(z - kZ) <= 4 && std::abs(x - kHead) <= 30 && y >= kY && y <= 150;
    const bool in_body = std::hypot(x - kBody, z - kZ) <= 50;
    return in_body || in_ear ||
           std::hypot(x - kBody - along, across) <= 50 - 20 * along / (kHead - kBody);
  });
  VolumeBuilder thin(solid.extent());
  for (int32_t y = kY - 50; y <= kY + 50; y += 2) thin.Add({kBody, y, kZ});
  for (int32_t x = kBody; x <= kHead; x += 2) thin.Add({x, kY, kZ});
  const int32_t top = into_ear ? 144 : kY;
  for (int32_t y = kY; y <= top; y += 2) thin.Add({kHead, y, kZ});
  const Volume curves = *std::move(thin).Build();
  ExactRadius radius(solid);
  std::vector<float> radii;
  curves.ForEachPoint([&](LatticePoint p) { radii.push_back(radius.At(p)); });
  const ThinSet set({curves, radii});
  return Significance(solid, {.thin = 1, .thick = 1}).Of(set, BranchFrom(set, {kHead, top, kZ}));
}

// The ear's run is the largest relative to its radius, but the ear is as wide as the head.
TEST(Significance, OfAHeadDoesNotDependOnTheEarThatItsBranchLeadsInto) {
  EXPECT_GT(Head(/*into_ear=*/false), 0.6);
  EXPECT_NEAR(Head(/*into_ear=*/true), Head(/*into_ear=*/false), 0.1);
}

// A rod along x and a branch in it that ends before it; returns the points that Append() adds.
BranchPath GoneOn(int32_t rod_end, int32_t branch_end) {
  const Volume rod = test::VolumeWhere({60, 20, 20}, [=](int32_t x, int32_t y, int32_t z) {
    return x <= rod_end && std::hypot(y - 20, z - 20) <= 5;
  });
  ExactRadius radius(rod);
  BranchPath path;
  for (int32_t x = 20; x <= branch_end; x += 2) {
    path.points.push_back({x, 20, 20});
    path.radii.push_back(radius.At({x, 20, 20}));
  }
  const size_t before = path.points.size();
  TipExtender(rod, radius).Append(path);
  path.points.erase(path.points.begin(), path.points.begin() + static_cast<ptrdiff_t>(before));
  return path;
}

TEST(TipExtender, FollowsTheLimbByAFewUnits) {
  const BranchPath path = GoneOn(80, 60);
  ASSERT_FALSE(path.points.empty());
  EXPECT_EQ(path.points.back(), (LatticePoint{62, 20, 20}));
}

TEST(TipExtender, EndsWhereTheObjectDoes) { EXPECT_TRUE(GoneOn(60, 60).points.empty()); }

TEST(Significance, OfAStrandInTheBallsOfAnotherIsNextToNothing) {
  EXPECT_LT(StrandBeside(8), 0.25 * StrandBeside(24));
}

}  // namespace
}  // namespace bccskel
