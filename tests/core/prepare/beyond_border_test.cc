#include "core/prepare/beyond_border.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/distance/exact_radius.h"
#include "core/exec/instruction_sets.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

using Spacing = std::array<double, 3>;

LatticeBox BoxOf(const LatticeExtent& extent, BorderPoints border) {
  const int32_t last = border == BorderPoints::kLastCorners ? 2 : 1;
  return {{0, 0, 0}, {2 * extent.nx - last, 2 * extent.ny - last, 2 * extent.nz - last}};
}

// All points of the image but a few, so most are far from background.
Volume NearlyFull(uint64_t seed, LatticeExtent extent, BorderPoints border, Spacing spacing) {
  VolumeBuilder builder(extent, {.spacing = spacing});
  test::ForEachPointIn(BoxOf(extent, border), [&](LatticePoint p) { builder.Add(p); });
  builder.Remove({0, 0, 0});
  for (LatticePoint p :
       test::RandomCloud(seed, extent, seed % 3 == 0 ? 0 : 0.001 * static_cast<double>(seed % 7))) {
    builder.Remove(p);
  }
  return *std::move(builder).Build();
}

Volume Continued(const Volume& object, BorderPoints border, const ImageFaces& faces = kAllFaces) {
  exec::UnlimitedMemory memory;
  auto space = ContinueBeyond(faces, object, border, memory);
  EXPECT_TRUE(space.ok()) << space.status();
  return *std::move(space);
}

DistanceField Measured(const Volume& object, const Volume& space, DistanceKind kind,
                       const exec::Context& context = {}) {
  auto field = MeasureIn(space, object, kind, context);
  EXPECT_TRUE(field.ok()) << field.status();
  return *std::move(field);
}

// The box with a cell of what is beyond the faces that the object does not continue across.
LatticeBox WithOthersAround(LatticeBox box, const ImageFaces& faces) {
  const auto cell = [&](size_t side) -> LatticePoint {
    return {faces[0][side] ? 0 : 2, faces[1][side] ? 0 : 2, faces[2][side] ? 0 : 2};
  };
  return {box.low - cell(0), box.high + cell(1)};
}

std::vector<LatticePoint> BackgroundOf(const Volume& object, BorderPoints border,
                                       const ImageFaces& faces = kAllFaces) {
  const LatticeBox box = BoxOf(object.extent(), border);
  std::vector<LatticePoint> background;
  test::ForEachPointIn(WithOthersAround(box, faces), [&](LatticePoint p) {
    if (!box.Contains(p) || !object.Contains(p)) background.push_back(p);
  });
  return background;
}

// As euclidean_scan.cc adds them up.
float SquareTo(LatticePoint p, LatticePoint q, const AxisScale& scale) {
  const auto square = [](double length) { return static_cast<float>(length * length); };
  const auto x = static_cast<float>(std::abs(p.x - q.x));
  return x * x * square(scale[0]) + square(scale[1] * (p.y - q.y)) + square(scale[2] * (p.z - q.z));
}

float SquareToNearest(LatticePoint p, const std::vector<LatticePoint>& background,
                      const AxisScale& scale) {
  float least = std::numeric_limits<float>::infinity();
  for (LatticePoint q : background) least = std::min(least, SquareTo(p, q, scale));
  return least;
}

constexpr std::array<LatticeExtent, 6> kExtents = {
    {{20, 9, 11}, {3, 30, 4}, {40, 2, 2}, {17, 5, 9}, {2, 2, 33}, {16, 8, 8}}};
constexpr std::array<bool, 2> kNone = {false, false}, kBoth = {true, true}, kFirst = {true, false},
                              kLast = {false, true};
constexpr std::array<ImageFaces, 10> kFaces = {{kAllFaces,
                                                {kNone, kNone, kBoth},
                                                {kBoth, kNone, kNone},
                                                {kNone, kBoth, kNone},
                                                {kBoth, kNone, kBoth},
                                                {kFirst, kNone, kNone},
                                                {kNone, kNone, kLast},
                                                {kBoth, kFirst, kNone},
                                                {kLast, kBoth, kFirst},
                                                {kLast, kFirst, kLast}}};
constexpr std::array<BorderPoints, 2> kBorders = {BorderPoints::kLastOfLattice,
                                                  BorderPoints::kLastCorners};

TEST(BeyondBorderLaw, EuclideanDistancesAreThoseToBackgroundOfTheImage) {
  for (uint64_t seed = 0; seed < 240; ++seed) {
    const LatticeExtent extent = kExtents[seed % 6];
    const BorderPoints border = kBorders[seed / 6 % 2];
    const Spacing spacing = seed / 12 % 2 == 0 ? Spacing{1, 1, 1} : Spacing{1, 1.3, 2.7};
    const ImageFaces& faces = kFaces[seed / 24];
    const Volume object = NearlyFull(seed, extent, border, spacing);
    const DistanceField field =
        Measured(object, Continued(object, border, faces), DistanceKind::kEuclidean);
    const AxisScale scale = AxisScaleOf(object.placement());
    const std::vector<LatticePoint> background = BackgroundOf(object, border, faces);
    object.ForEachPoint([&](LatticePoint p) {
      const float least = SquareToNearest(p, background, scale);
      const BrickAddress at = AddressOf(p);
      const float square = field.SquareAt(*object.Find(BrickKey(at.brick)), at.bit);
      if (scale == kIsotropic) {
        ASSERT_EQ(square, least) << seed << ": " << p.x << " " << p.y << " " << p.z;
      } else {
        ASSERT_NEAR(square / least, 1, 1e-6) << seed << ": " << p.x << " " << p.y << " " << p.z;
      }
    });
  }
}

// Also from points beyond the border, where pruning looks on.
TEST(BeyondBorderLaw, RadiiAreThoseToBackgroundOfTheImage) {
  for (uint64_t seed = 0; seed < 240; ++seed) {
    const BorderPoints border = kBorders[seed / 6 % 2];
    const Spacing spacing = seed / 12 % 2 == 0 ? Spacing{1, 1, 1} : Spacing{1, 1.3, 2.7};
    const ImageFaces& faces = kFaces[seed / 24];
    const Volume object = NearlyFull(seed, kExtents[seed % 6], border, spacing);
    const Volume space = Continued(object, border, faces);
    const AxisScale scale = AxisScaleOf(object.placement());
    std::vector<LatticePoint> background = BackgroundOf(object, border, faces);
    ExactRadius radius(space);
    LatticeBox around = BoxOf(object.extent(), border);
    const LatticePoint out = faces == kAllFaces ? LatticePoint{9, 9, 9} : LatticePoint{0, 0, 0};
    around = {around.low - out, around.high + out};
    test::ForEachPointIn(around, [&](LatticePoint p) {
      if ((p.x + 3 * p.y + 5 * p.z) % 7 != 0 || std::ranges::count(background, p) != 0) return;
      const float least = SquareToNearest(p, background, scale);
      ASSERT_NEAR(radius.SquaredAt(p) / least, 1, 1e-6) << seed;
      // Where it continues beyond some faces only, one as near beyond a corner of the window may be
      // found.
      if (faces == kAllFaces) {
        ASSERT_EQ(std::ranges::count(background, radius.nearest()), 1) << seed;
      }
      if (!object.Contains(p)) return;
      const LatticePoint first = radius.FirstNearestAt(p, radius.At(p));
      ASSERT_EQ(std::ranges::count(background, first), 1) << seed;
      ASSERT_EQ(radius.Between(p, first), radius.At(p)) << seed;
    });
  }
}

// More points than are measured at once, and most columns have no background at all.
TEST(BeyondBorderLaw, DistancesInALargeImageOfFewHolesAreFinite) {
  constexpr LatticeExtent kExtent = {101, 101, 101};
  constexpr LatticePoint kHole = {31, 75, 151};
  for (const BorderPoints border : kBorders) {
    VolumeBuilder builder(kExtent);
    test::ForEachPointIn(BoxOf(kExtent, border), [&](LatticePoint p) { builder.Add(p); });
    builder.Remove(kHole);
    const Volume object = *std::move(builder).Build();
    const Volume space = Continued(object, border);
    const DistanceField field = Measured(object, space, DistanceKind::kEuclidean);
    for (BrickIndex n = 0; n < object.brick_count(); ++n) {
      object.bricks()[n].ForEachSetBit([&](int bit) {
        const LatticePoint p = PointOf(object.keys()[n].coordinates(), bit);
        ASSERT_EQ(field.SquareAt(n, bit), SquareTo(p, kHole, kIsotropic))
            << p.x << " " << p.y << " " << p.z;
      });
    }
  }
}

// The image with all points beyond across the axes, farther out than any distance within.
Volume WithAllAround(const Volume& object, const LatticeBox& box, LatticePoint shift,
                     const ImageFaces& faces) {
  const LatticeExtent& extent = object.extent();
  VolumeBuilder builder({extent.nx + shift.x, extent.ny + shift.y, extent.nz + shift.z},
                        object.placement());
  LatticeBox all = {{0, 0, 0}, box.high + shift + shift};
  const auto end = [&](size_t axis, int32_t LatticePoint::*at) {
    if (!faces[axis][0]) all.low.*at = shift.*at;
    if (!faces[axis][1]) all.high.*at = box.high.*at + shift.*at;
  };
  end(0, &LatticePoint::x);
  end(1, &LatticePoint::y);
  end(2, &LatticePoint::z);
  test::ForEachPointIn(all, [&](LatticePoint p) {
    if (!box.Contains(p - shift) || object.Contains(p - shift)) builder.Add(p);
  });
  return *std::move(builder).Build();
}

TEST(BeyondBorderLaw, ChamferDistancesAreThoseToBackgroundOfTheImage) {
  constexpr LatticePoint kShift = {96, 96, 96};
  for (uint64_t seed = 0; seed < 30; ++seed) {
    const LatticeExtent extent = kExtents[seed % 6];
    const BorderPoints border = kBorders[seed / 3 % 2];
    const ImageFaces& faces = kFaces[seed % 10];
    const Spacing spacing = seed % 2 == 0 ? Spacing{1, 1, 1} : Spacing{1, 1.3, 1.2};
    const Volume object = NearlyFull(seed, extent, border, spacing);
    const Volume all = WithAllAround(object, BoxOf(extent, border), kShift, faces);
    const auto expected = ComputeDistance(all, DistanceKind::kChamfer, {});
    ASSERT_TRUE(expected.ok());
    const DistanceField field =
        Measured(object, Continued(object, border, faces), DistanceKind::kChamfer);
    object.ForEachPoint([&](LatticePoint p) {
      const BrickAddress there = AddressOf(p + kShift), here = AddressOf(p);
      ASSERT_EQ(field.At(*object.Find(BrickKey(here.brick)), here.bit),
                expected->At(*all.Find(BrickKey(there.brick)), there.bit))
          << seed << ": " << p.x << " " << p.y << " " << p.z;
    });
  }
}

TEST(BeyondBorderLaw, DistancesHaveTheSameBitsForAnyInstructionSetAndThreads) {
  const Volume object =
      NearlyFull(4, {50, 20, 30}, BorderPoints::kLastOfLattice, Spacing{1, 1.3, 2.7});
  const Volume space = Continued(object, BorderPoints::kLastOfLattice);
  const DistanceField expected = Measured(object, space, DistanceKind::kEuclidean);
  for (const std::string& name : exec::SupportedInstructionSets()) {
    ASSERT_TRUE(exec::ChooseInstructionSet(name));
    for (const int threads : {1, 3}) {
      test::TeamContext context(threads);
      const DistanceField field = Measured(object, space, DistanceKind::kEuclidean, context);
      EXPECT_EQ(field.values(), expected.values()) << name;
    }
  }
  exec::ChooseInstructionSet("");
}

}  // namespace
}  // namespace bccskel
