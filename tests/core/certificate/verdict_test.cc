#include <gtest/gtest.h>

#include "core/certificate/describe_changes.h"

namespace bccskel {
namespace {

constexpr BettiNumbers kOne = {1, 2, 0}, kOther = {1, 1, 0}, kThird = {2, 1, 3};

TEST(VerdictInWords, NamesEachStepThatChangedTheTopology) {
  EXPECT_EQ(VerdictInWords({.input = kOne, .skeleton = kOne}), "topology kept");
  EXPECT_EQ(VerdictInWords({.mask = kOne, .unprepared = kOne, .input = kOne, .skeleton = kOne}),
            "topology kept");
  EXPECT_EQ(VerdictInWords({.mask = kOne, .unprepared = kOne, .input = kOther, .skeleton = kOther}),
            "topology of the prepared object kept, preparing changed loops 2 -> 1");
  EXPECT_EQ(VerdictInWords({.mask = kOne, .input = kOne, .skeleton = kOne, .sampled = true}),
            "topology of the sampled object kept, sampling may have changed the mask's");
  EXPECT_EQ(VerdictInWords({.mask = kOne, .input = kOther, .skeleton = kOther, .sampled = true}),
            "topology of the sampled object kept, sampling changed loops 2 -> 1");
  EXPECT_EQ(VerdictInWords({.mask = kOne,
                            .unprepared = kOther,
                            .input = kThird,
                            .skeleton = kThird,
                            .sampled = true}),
            "topology of the prepared object kept, sampling changed loops 2 -> 1, preparing "
            "changed components 1 -> 2, cavities 0 -> 3");
  EXPECT_EQ(VerdictInWords({.mask = kOne, .input = kOne, .skeleton = kOther}), "TOPOLOGY NOT KEPT");
}

TEST(Certificate, OfObjectsSideBySideIsTheSum) {
  Certificate sum;
  sum += {.mask = kOne, .input = kOne, .skeleton = kOne};
  sum += {.mask = kThird,
          .unprepared = kThird,
          .input = kOther,
          .skeleton = kOther,
          .simple_points_left = 4,
          .sampled = true};
  const BettiNumbers given = {3, 3, 3}, thinned = {2, 3, 0};
  const Certificate expected = {.mask = given,
                                .unprepared = given,
                                .input = thinned,
                                .skeleton = thinned,
                                .simple_points_left = 4,
                                .sampled = true};
  EXPECT_EQ(sum, expected);
}

}  // namespace
}  // namespace bccskel
