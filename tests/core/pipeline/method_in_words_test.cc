#include "core/pipeline/method_in_words.h"

#include <gtest/gtest.h>

#include <set>

namespace bccskel {
namespace {

TEST(MethodInWords, SaysKindMethodAndDistance) {
  EXPECT_EQ(MethodInWords({.method = ThinningMethod::kSymmetric, .kind = SkeletonKind::kSurface},
                          DistanceKind::kEuclidean),
            "surface skeleton by parallel symmetric thinning on the body-centered cubic grid by "
            "Euclidean shells");
}

TEST(MethodInWords, TellsAllCombinationsApart) {
  std::set<std::string> words;
  for (int method = 0; method < 3; ++method) {
    for (int kind = 0; kind < 4; ++kind) {
      for (int distance = 0; distance < 3; ++distance) {
        const ThinningOptions thinning = {.method = static_cast<ThinningMethod>(method),
                                          .kind = static_cast<SkeletonKind>(kind)};
        words.insert(MethodInWords(thinning, static_cast<DistanceKind>(distance)));
      }
    }
  }
  EXPECT_EQ(words.size(), 36u);
}

}  // namespace
}  // namespace bccskel
