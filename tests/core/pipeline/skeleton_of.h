#ifndef BCCSKEL_TESTS_CORE_PIPELINE_SKELETON_OF_H_
#define BCCSKEL_TESTS_CORE_PIPELINE_SKELETON_OF_H_

#include <gtest/gtest.h>

#include <utility>

#include "core/pipeline/skeletonize.h"
#include "tests/support/contexts.h"

namespace bccskel::test {

inline SkeletonizeResult SkeletonOf(const Volume& object, const SkeletonizeOptions& options,
                                    int threads = 1) {
  TeamContext context(threads);
  auto result = Skeletonize(object, options, context);
  EXPECT_TRUE(result.ok()) << result.status();
  return *std::move(result);
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_PIPELINE_SKELETON_OF_H_
