#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/distance/chamfer_rows.h"
#include "core/distance/distance_field.h"
#include "core/exec/instruction_sets.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_distance.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

void ExpectReferenceDistances(const Volume& object, const exec::Context& context) {
  const auto field = ComputeDistance(object, DistanceKind::kChamfer, context);
  ASSERT_TRUE(field.ok()) << field.status();
  const test::ReferencePointSet points(object);
  const std::vector<uint32_t> expected = test::ReferenceChamfer(points);
  uint32_t largest = 0;
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    for (int bit = 0; bit < kBrickPoints; ++bit) {
      const LatticePoint p = PointOf(object.keys()[n].coordinates(), bit);
      const uint32_t wanted = points.Contains(p) ? expected[points.Index(p)] : 0;
      ASSERT_EQ(field->At(n, bit), wanted) << p.x << " " << p.y << " " << p.z;
      largest = std::max(largest, wanted);
    }
  }
  EXPECT_EQ(field->largest(), largest);
}

TEST(ChamferDistance, WeightsAreRootThreeAndTwoOfTheUnit) {
  for (const ChamferWeights& w : {kShortChamfer, kLongChamfer}) {
    const double unit = w.counts_per_unit;
    for (uint32_t axial : w.axial) EXPECT_EQ(axial / unit, 2);
    EXPECT_NEAR(w.diagonal / unit, std::sqrt(3.0), 1e-4);
  }
}

// The promise of both headers: fixed point rounds as the real weights do.
TEST(ChamferDistance, FixedPointRoundsAsTheRealWeightsDo) {
  struct Range {
    ChamferWeights weights;
    int units;
  };
  for (const Range& range : {Range{kShortChamfer, 627}, Range{kLongChamfer, 4200}}) {
    const auto& w = range.weights;
    for (int diagonal = 0; diagonal * std::sqrt(3.0) < range.units; ++diagonal) {
      for (int axial = 0; diagonal * std::sqrt(3.0) + 2 * axial < range.units; ++axial) {
        const double real = diagonal * std::sqrt(3.0) + 2 * axial;
        const uint64_t counts = uint64_t{w.diagonal} * static_cast<uint64_t>(diagonal) +
                                uint64_t{w.axial[0]} * static_cast<uint64_t>(axial);
        const auto half_units = static_cast<uint64_t>(2 * w.counts_per_unit);
        const auto rounded = (4 * counts + half_units) / (2 * half_units);
        ASSERT_EQ(static_cast<double>(rounded), std::floor(real + 0.5)) << diagonal << "," << axial;
      }
    }
  }
}

class ChamferDistanceLaw : public testing::TestWithParam<uint64_t> {};

TEST_P(ChamferDistanceLaw, AgreesWithTheReferenceOnRandomObjects) {
  const uint64_t seed = GetParam();
  const LatticeExtent extent = {37, 21, 19};
  std::vector<std::vector<LatticePoint>> objects;
  for (double density : {0.3, 0.9, 0.999}) {
    objects.push_back(test::RandomCloud(seed, extent, density));
  }
  objects.push_back(test::RandomBlob(seed, extent, 5, 14));
  for (const std::vector<LatticePoint>& points : objects) {
    const Volume object = VolumeOfPoints(points);
    for (int threads : {1, 3}) {
      for (double patience : {1e9, -1e9}) {  // never and at once on with one worker
        test::TeamContext context(threads);
        context.patience = patience;
        ExpectReferenceDistances(object, context);
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, ChamferDistanceLaw, testing::Range<uint64_t>(0, 6));

TEST(ChamferDistance, IsTheSameOnEveryInstructionSet) {
  const Volume object = VolumeOfPoints(test::RandomBlob(7, {40, 30, 30}, 6, 18));
  for (const std::string& name : exec::SupportedInstructionSets()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(exec::ChooseInstructionSet(name));
    ExpectReferenceDistances(object, exec::Context());
  }
  exec::ChooseInstructionSet("");
}

// A plate is thin but so wide that distances within a layer overflow 16 bits on the way.
TEST(ChamferDistance, DoesNotOverflowInAWidePlate) {
  const Volume plate =
      test::VolumeWhere({700, 700, 2}, [](int32_t x, int32_t, int32_t) { return x % 2 == 0; });
  const auto field = ComputeDistance(plate, DistanceKind::kChamfer, exec::Context());
  ASSERT_TRUE(field.ok());
  EXPECT_EQ(field->weights(), kShortChamfer);
  // Above and below every point lies background of the other sublattice.
  EXPECT_EQ(field->largest(), kShortChamfer.diagonal);
}

// The 32-bit loops are for objects deeper than 620 units; here they are held against the 16-bit
// ones.
TEST(ChamferDistance, LongAndShortLoopsGiveTheSameMixturesOfSteps) {
  const Volume object = VolumeOfPoints(test::RandomBlob(3, {30, 30, 30}, 4, 16));
  const std::vector<BrickNeighborhood> neighbors = FindBrickNeighbors(object.keys());
  std::vector<uint32_t> values((object.brick_count() + 1) * kBrickPoints);
  // With the short weights both must agree to the last count.
  const DistanceView<uint32_t> view = {object.padded_bricks().data(), neighbors.data(),
                                       values.data(), kShortChamfer};
  BrickIndex first = 0;
  std::vector<std::array<std::vector<BrickIndex>, 2>> slabs;
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    const BrickCoordinates brick = object.keys()[n].coordinates();
    if (n == 0 || brick.bz != object.keys()[n - 1].coordinates().bz) {
      if (n != 0) SweepWithinLayers(view, first, n);
      first = n;
      slabs.emplace_back();
    }
    slabs.back()[static_cast<size_t>(brick.sublattice)].push_back(n);
  }
  SweepWithinLayers(view, first, static_cast<BrickIndex>(object.brick_count()));
  for (const auto& slab : slabs) {
    for (int k = 0; k < kBrickZ; ++k) {
      JoinLayers(view, Sublattice::kEven, slab[0], k, ScanDirection::kUpward);
      JoinLayers(view, Sublattice::kOdd, slab[1], k, ScanDirection::kUpward);
    }
  }
  for (size_t s = slabs.size(); s-- > 0;) {
    for (int k = kBrickZ - 1; k >= 0; --k) {
      JoinLayers(view, Sublattice::kOdd, slabs[s][1], k, ScanDirection::kDownward);
      JoinLayers(view, Sublattice::kEven, slabs[s][0], k, ScanDirection::kDownward);
    }
  }
  const auto field = ComputeDistance(object, DistanceKind::kChamfer, exec::Context());
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    for (int bit = 0; bit < kBrickPoints; ++bit) {
      ASSERT_EQ(values[size_t{n} * kBrickPoints + static_cast<size_t>(bit)], field->At(n, bit));
    }
  }
}

TEST(ChamferWeights, ForEqualSpacingAreThePapers) {
  EXPECT_EQ(ShortWeights(kIsotropic), kShortChamfer);
  EXPECT_EQ(LongWeights(kIsotropic), kLongChamfer);
}

TEST(ChamferWeights, AreTheLengthsOfTheStepsInTheWorld) {
  for (const AxisScale& scale : {AxisScale{1, 1, 5}, AxisScale{1.7, 1, 2.2}, AxisScale{9, 30, 1}}) {
    const ChamferWeights w = LongWeights(scale);
    const double diagonal = std::hypot(scale[0], scale[1], scale[2]);
    EXPECT_NEAR(w.diagonal / w.counts_per_unit / diagonal, 1, 1e-3);
    for (size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(w.axial[axis] / w.counts_per_unit / (2 * scale[axis]), 1, 1e-3);
    }
  }
}

TEST(ChamferWeights, WithTheOptimalUnitErrElevenPercentEitherWay) {
  EXPECT_NEAR(LargestOverestimate(kIsotropic), 1.239, 5e-4);
  const ChamferWeights w = WithOptimalUnit(kLongChamfer, kIsotropic);
  EXPECT_NEAR(w.diagonal / w.counts_per_unit, 1.54695, 1e-4);
  EXPECT_NEAR(w.axial[0] / w.counts_per_unit, 1.78626, 1e-4);
}

// The distance by all steps, relaxed until nothing changes.
std::vector<uint32_t> RelaxedDistances(const Volume& object, const ChamferWeights& weights) {
  const test::ReferencePointSet set(object);
  std::vector<uint32_t> counts(set.box_size(), 0);
  const std::vector<LatticePoint> points = set.SortedPoints();
  for (LatticePoint p : points) counts[set.Index(p)] = 1u << 30;
  for (bool changed = true; changed;) {
    changed = false;
    for (LatticePoint p : points) {
      for (int bit = 0; bit < kNeighborCount; ++bit) {
        const uint32_t step =
            bit < 8 ? weights.diagonal : weights.axial[static_cast<size_t>(bit - 8) / 2];
        const uint32_t by_step = counts[set.Index(p + Direction(bit).offset())] + step;
        if (by_step >= counts[set.Index(p)]) continue;
        counts[set.Index(p)] = by_step;
        changed = true;
      }
    }
  }
  return counts;
}

void ExpectRelaxedDistances(const Volume& object) {
  const auto field = ComputeDistance(object, DistanceKind::kChamferOptimal, exec::Context());
  ASSERT_TRUE(field.ok());
  const test::ReferencePointSet points(object);
  const std::vector<uint32_t> expected = RelaxedDistances(object, field->weights());
  for (BrickIndex n = 0; n < object.brick_count(); ++n) {
    object.bricks()[n].ForEachSetBit([&](int bit) {
      const LatticePoint p = PointOf(object.keys()[n].coordinates(), bit);
      ASSERT_EQ(field->At(n, bit), expected[points.Index(p)]);
    });
  }
}

TEST_P(ChamferDistanceLaw, MeasuresUnequalSpacingsByTheirShortestPaths) {
  const auto points = test::RandomBlob(GetParam(), {37, 21, 19}, 5, 14);
  for (const auto& spacing :
       {std::array{1.0, 1.0, 5.0}, std::array{3.0, 1.1, 1.0}, std::array{0.2, 1.0, 0.3},
        std::array{90.0, 1.0, 1.0}, std::array{1.0, 1.0, 1e9}}) {
    ExpectRelaxedDistances(test::VolumeWith(points, {40, 24, 22}, {.spacing = spacing}));
  }
}

TEST(ChamferDistance, StopsWhenAsked) {
  const Volume object = VolumeOfPoints(test::RandomBlob(1, {20, 20, 20}, 3, 9));
  const exec::Context context = test::Stopped();
  EXPECT_EQ(ComputeDistance(object, DistanceKind::kChamfer, context).status().code(),
            absl::StatusCode::kCancelled);
  const exec::Context late = test::Late();
  EXPECT_EQ(ComputeDistance(object, DistanceKind::kChamfer, late).status().code(),
            absl::StatusCode::kDeadlineExceeded);
}

TEST(ChamferDistance, OfAnEmptyObjectIsEmpty) {
  const auto field = ComputeDistance(Volume(), DistanceKind::kChamfer, exec::Context());
  ASSERT_TRUE(field.ok());
  EXPECT_EQ(field->largest(), 0u);
}

}  // namespace
}  // namespace bccskel
