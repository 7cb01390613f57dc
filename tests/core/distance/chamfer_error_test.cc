// How far chamfer distances on the lattice are from Euclidean ones, whatever the weights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/reference_distance.h"

namespace bccskel {
namespace {

// The distance of |x| >= |y| >= |z| on the lattice: y diagonal steps, then axial ones.
double Chamfer(double diagonal, double axial, double x, double y) {
  return axial / 2 * (x - y) + diagonal * y;
}

struct Errors {
  double below = std::numeric_limits<double>::infinity();
  double above = -std::numeric_limits<double>::infinity();

  double Largest() const { return std::max(above, -below); }
};

// Relative errors over all directions.
Errors ErrorsOf(double diagonal, double axial) {
  constexpr int kSteps = 1000;
  Errors errors;
  for (int j = 0; j <= kSteps; ++j) {
    for (int k = 0; k <= j; ++k) {
      const double y = j / double{kSteps}, z = k / double{kSteps};
      const double error = Chamfer(diagonal, axial, 1, y) / std::hypot(1, y, z) - 1;
      errors.below = std::min(errors.below, error);
      errors.above = std::max(errors.above, error);
    }
  }
  return errors;
}

TEST(ChamferError, TheFormulaIsTheShortestPathOfSteps) {
  const LatticePoint origin = {};
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y <= x; ++y) {
      for (int z = 0; z <= y; ++z) {
        if (!IsOnLattice({x, y, z})) continue;
        const double counts = Chamfer(test::kReferenceDiagonal, test::kReferenceAxial, x, y);
        EXPECT_EQ(test::ReferenceChamferBetween(origin, {x, y, z}), counts);
      }
    }
  }
}

TEST(ChamferError, OfThePapersWeightsIsUpTo24PercentAndNeverBelow) {
  const Errors errors = ErrorsOf(std::sqrt(3.0), 2);
  EXPECT_NEAR(errors.above, 0.239, 5e-4);
  EXPECT_NEAR(errors.below, 0, 1e-12);
}

TEST(ChamferError, OfTheBestWeightsIs11PercentEitherWay) {
  EXPECT_NEAR(ErrorsOf(1.54695, 1.78626).Largest(), 0.1069, 5e-5);
  EXPECT_NEAR(ErrorsOf(6 / 3.8826, 7 / 3.8826).Largest(), 0.1078, 5e-5);
  EXPECT_NEAR(ErrorsOf(13 / 8.4003, 15 / 8.4003).Largest(), 0.1072, 5e-5);
}

}  // namespace
}  // namespace bccskel
