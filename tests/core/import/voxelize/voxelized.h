#ifndef BCCSKEL_TESTS_CORE_IMPORT_VOXELIZE_VOXELIZED_H_
#define BCCSKEL_TESTS_CORE_IMPORT_VOXELIZE_VOXELIZED_H_

#include <gtest/gtest.h>

#include "core/import/voxelize/voxelize.h"

namespace bccskel::test {

// The mesh voxelized along the world's axes, on one thread; a failure of the test where it is
// refused.
inline VoxelizeResult Voxelized(const TriangleMesh& mesh, VoxelizeOptions options) {
  options.axes = LatticeAxes::kWorld;
  auto result = Voxelize(mesh, options, {});
  EXPECT_TRUE(result.ok()) << result.status();
  return result.ok() ? *std::move(result) : VoxelizeResult{};
}

inline VoxelizeResult WithSpacing(const TriangleMesh& mesh, double spacing,
                                  FillRule fill = FillRule::kAuto) {
  return Voxelized(mesh, {.spacing = spacing, .fill = fill});
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_IMPORT_VOXELIZE_VOXELIZED_H_
