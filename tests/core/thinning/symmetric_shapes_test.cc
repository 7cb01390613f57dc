#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/certificate/certificate.h"
#include "core/distance/distance_field.h"
#include "core/import/shapes/shapes.h"
#include "core/thinning/thinning.h"
#include "tests/core/thinning/thin.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/reference_thinner.h"

// Symmetric thinning of every generated shape: the reference's bits, the object's topology, and
// nothing thick.

namespace bccskel::symmetric_shapes {
namespace {

using test::Symmetric;
using test::Thin;

struct Case {
  Shape shape;
  SkeletonKind kind;
};

std::vector<Case> AllCases() {
  std::vector<Case> cases;
  for (Shape shape : kShapes) {
    for (SkeletonKind kind : {SkeletonKind::kCurve, SkeletonKind::kSurface, SkeletonKind::kKernel,
                              SkeletonKind::kIsthmusCurve}) {
      cases.push_back({shape, kind});
    }
  }
  return cases;
}

Volume Generate(Shape shape, uint64_t points, double noise) {
  auto volume = GenerateShape(shape, {.points = points, .seed = 1, .noise = noise});
  EXPECT_TRUE(volume.ok()) << volume.status();
  return *std::move(volume);
}

class SymmetricShapes : public testing::TestWithParam<Case> {};

TEST_P(SymmetricShapes, EngineAndReferenceGiveTheSamePoints) {
  const auto [shape, kind] = GetParam();
  const Volume object = Generate(shape, 8'000, kind == SkeletonKind::kCurve ? 0.05 : 0.01);
  const ThinningOptions options = Symmetric(kind);
  const std::vector<LatticePoint> expected = test::ReferenceThin(object, options);
  for (int threads : {1, 3}) {
    EXPECT_TRUE(Thin(object, options, threads).thin.SortedPoints() == expected)
        << threads << " threads";
  }
}

TEST_P(SymmetricShapes, TopologyIsKeptWithEveryDistance) {
  const auto [shape, kind] = GetParam();
  const Volume object = Generate(shape, 20'000, 0);
  const BettiNumbers betti = *CountBettiNumbers(object, {});  // flood fills would take seconds
  for (DistanceKind distance :
       {DistanceKind::kChamfer, DistanceKind::kChamferOptimal, DistanceKind::kEuclidean}) {
    const Volume thin = Thin(object, Symmetric(kind), 2, distance).thin;
    EXPECT_EQ(*CountBettiNumbers(thin, {}), betti);
    if (kind == SkeletonKind::kCurve || kind == SkeletonKind::kKernel) {
      EXPECT_EQ(test::ReferenceSimpleNonEndPoints(test::ReferencePointSet(thin)), 0u);
    }
  }
}

std::string NameOf(const testing::TestParamInfo<Case>& info) {
  constexpr const char* kKinds[] = {"Curve", "Surface", "Kernel", "IsthmusCurve"};
  std::string name(ShapeName(info.param.shape));
  std::erase(name, '-');
  return name + kKinds[static_cast<size_t>(info.param.kind)];
}

INSTANTIATE_TEST_SUITE_P(Shapes, SymmetricShapes, testing::ValuesIn(AllCases()), NameOf);

}  // namespace
}  // namespace bccskel::symmetric_shapes
