#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/certificate/certificate.h"
#include "core/import/shapes/shapes.h"
#include "core/thinning/thinning.h"
#include "tests/core/thinning/thin.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/reference_thinner.h"

// The engine against the slow reference on every generated shape, clean and noisy.

namespace bccskel::reference_shapes {
namespace {

using test::Thin;

class ShapesAgreement : public testing::TestWithParam<Shape> {
 protected:
  static Volume Generate(double noise) {
    auto volume = GenerateShape(GetParam(), {.points = 20'000, .seed = 1, .noise = noise});
    EXPECT_TRUE(volume.ok()) << volume.status();
    return *std::move(volume);
  }
};

TEST_P(ShapesAgreement, EngineAndReferenceGiveTheSamePoints) {
  for (double noise : {0.0, 0.05}) {
    SCOPED_TRACE(noise);
    const Volume object = Generate(noise);
    const test::ReferenceThinning expected = test::ReferenceThinCounted(object, {});
    for (int threads : {1, 3}) {
      const ThinningResult result = Thin(object, {}, threads);
      EXPECT_TRUE(result.thin.SortedPoints() == expected.thin) << threads << " threads";
      EXPECT_EQ(result.removed, expected.removed);
      EXPECT_EQ(result.removed_by_cleanup, expected.removed_by_cleanup);
      EXPECT_EQ(result.last_shell, expected.last_shell);
      EXPECT_EQ(result.passes, expected.passes);
    }
  }
}

TEST_P(ShapesAgreement, ThinningKeepsTheTopologyAndLeavesNoSimpleNonEndPoint) {
  const Volume object = Generate(0);
  const Volume thin = Thin(object, {}, 2).thin;
  EXPECT_EQ(*CountBettiNumbers(thin, {}), *CountBettiNumbers(object, {}));  // without flood fills
  EXPECT_EQ(test::ReferenceSimpleNonEndPoints(test::ReferencePointSet(thin)), 0u);
}

// The paper's unit of shells, and shells wider than a brick is thick.
TEST_P(ShapesAgreement, HoldsForWideShells) {
  const Volume object = Generate(0.02);
  for (double width : {2.0, 7.5, 64.0}) {
    ThinningOptions options;
    options.shell_width = width;
    EXPECT_TRUE(Thin(object, options, 2).thin.SortedPoints() ==
                test::ReferenceThin(object, options))
        << width;
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, ShapesAgreement, testing::ValuesIn(kShapes), [](const auto& info) {
  std::string name(ShapeName(info.param));
  std::erase(name, '-');
  return name;
});

}  // namespace
}  // namespace bccskel::reference_shapes
