#include "core/labels/skeletonize_labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <thread>
#include <utility>
#include <vector>

#include "core/labels/ordered_delivery.h"
#include "tests/core/labels/label_volume.h"
#include "tests/core/mask/mask_words.h"
#include "tests/support/contexts.h"

namespace bccskel {
namespace {

using ::testing::HasSubstr;

// Large enough for many small objects and, with the limit below, some large ones in between.
const LabeledObjects& Objects() {
  static const LabeledObjects kObjects = test::Collected(test::BallLabels(3, 66, 40, 30, 16, 8));
  return kObjects;
}
constexpr uint64_t kLarge = 1200;

std::vector<LabelSkeleton> Skeletons(int threads, const LabelsOptions& options) {
  test::TeamContext context(threads);
  std::vector<LabelSkeleton> skeletons;
  const absl::Status status = SkeletonizeLabels(
      Objects(), options,
      [&](LabelSkeleton&& skeleton) {
        skeletons.push_back(std::move(skeleton));
        return absl::OkStatus();
      },
      context);
  EXPECT_TRUE(status.ok()) << status;
  return skeletons;
}

TEST(SkeletonizeLabels, HasLargeAndSmallObjectsInThisTest) {
  int large = 0;
  for (const LabeledObject& object : Objects().objects) large += object.voxels >= kLarge ? 1 : 0;
  EXPECT_GT(large, 2);
  EXPECT_LT(large, 12);
}

TEST(SkeletonizeLabels, KeepsTheTopologyOfEveryLabel) {
  const test::LabelVolume volume = test::BallLabels(3, 66, 40, 30, 16, 8);
  for (MaskAdjacency adjacency : test::kBothAdjacencies) {
    const std::vector<LabelSkeleton> skeletons = Skeletons(2, {.mask = {.adjacency = adjacency}});
    ASSERT_EQ(skeletons.size(), Objects().objects.size());
    for (size_t n = 0; n < skeletons.size(); ++n) {
      const LabelSkeleton& skeleton = skeletons[n];
      EXPECT_EQ(skeleton.label, Objects().objects[n].label);
      EXPECT_EQ(skeleton.voxels, Objects().objects[n].voxels);
      const BettiNumbers expected =
          test::ReferenceMaskBetti(volume.MaskOf(skeleton.label), test::ReachOf(adjacency));
      EXPECT_EQ(skeleton.result.certificate.mask, expected);
      EXPECT_EQ(skeleton.result.certificate.input, expected);
      EXPECT_EQ(skeleton.result.certificate.skeleton, expected);
    }
  }
}

TEST(SkeletonizeLabels, GivesTheSameBitsInTheSameOrderForAnyThreads) {
  const std::vector<LabelSkeleton> one = Skeletons(1, {.large_voxels = kLarge});
  for (int threads : {2, 8}) {
    for (uint64_t large : {kLarge, uint64_t{1}, ~uint64_t{0}}) {
      const std::vector<LabelSkeleton> many = Skeletons(threads, {.large_voxels = large});
      ASSERT_EQ(many.size(), one.size());
      for (size_t n = 0; n < one.size(); ++n) {
        EXPECT_EQ(many[n].label, one[n].label);
        EXPECT_EQ(many[n].result.graph, one[n].result.graph);
        EXPECT_EQ(many[n].result.thin, one[n].result.thin);
        EXPECT_EQ(many[n].result.sha256, one[n].result.sha256);
      }
    }
  }
}

TEST(SkeletonizeLabels, EndsWithTheConsumersError) {
  for (int threads : {1, 4}) {
    test::TeamContext context(threads);
    int taken = 0;
    const absl::Status status = SkeletonizeLabels(
        Objects(), {},
        [&](LabelSkeleton&&) {
          return ++taken == 3 ? absl::UnavailableError("the client is gone") : absl::OkStatus();
        },
        context);
    EXPECT_EQ(status, absl::UnavailableError("the client is gone"));
    EXPECT_EQ(taken, 3);
  }
}

TEST(SkeletonizeLabels, StopsWhenCancelledFromInside) {
  std::stop_source source;
  test::TeamContext context(2);
  context.stop = source.get_token();
  const absl::Status status = SkeletonizeLabels(
      Objects(), {},
      [&](LabelSkeleton&&) {
        source.request_stop();
        return absl::OkStatus();
      },
      context);
  EXPECT_EQ(status.code(), absl::StatusCode::kCancelled);
}

TEST(SkeletonizeLabels, NamesTheLabelThatFails) {
  LabelsOptions options;
  options.mask.max_bricks = 3;
  const absl::Status status =
      SkeletonizeLabels(Objects(), options, [](LabelSkeleton&&) { return absl::OkStatus(); }, {});
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(std::string(status.message()), HasSubstr("label "));
}

TEST(SkeletonizeLabels, EndsWithAnErrorWhenAWorkerFindsNoMemory) {
  for (int threads : {1, 2}) {
    test::TeamContext context(threads);
    const absl::Status status = SkeletonizeLabels(
        Objects(), {}, [](LabelSkeleton&&) -> absl::Status { throw std::bad_alloc(); }, context);
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted) << status;
  }
}

TEST(SkeletonizeLabels, OfNothingDeliversNothing) {
  const LabeledObjects nothing{{4, 4, 4, {}}, {}};
  EXPECT_TRUE(SkeletonizeLabels(nothing, {},
                                [](LabelSkeleton&&) { return absl::InternalError("called"); }, {})
                  .ok());
}

TEST(OrderedDelivery, HandsOnInOrderWhateverTheOrderOfArrival) {
  std::vector<uint64_t> labels;
  const LabelConsumer consume = [&](LabelSkeleton&& skeleton) {
    labels.push_back(skeleton.label);
    return absl::OkStatus();
  };
  OrderedDelivery delivery(consume, 10);
  for (uint64_t n : {3u, 1u, 2u, 0u, 4u}) delivery.Add(n, {n, 0, {}});
  EXPECT_THAT(labels, ::testing::ElementsAre(0, 1, 2, 3, 4));
}

TEST(OrderedDelivery, LetsNoResultRunAheadOfTheWindow) {
  const LabelConsumer consume = [](LabelSkeleton&&) { return absl::OkStatus(); };
  OrderedDelivery delivery(consume, 2);
  EXPECT_TRUE(delivery.WaitForTurn(1, {}));
  std::atomic<int> passed = 0;
  std::jthread ahead([&] {
    EXPECT_TRUE(delivery.WaitForTurn(2, {}));
    passed = 1;
  });
  delivery.Add(1, {});
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_EQ(passed, 0);
  delivery.Add(0, {});
  ahead.join();
  EXPECT_EQ(passed, 1);
}

}  // namespace
}  // namespace bccskel
