#include "core/ranks/rank_skeletonize.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/volume/layer_part.h"
#include "tests/core/ranks/thread_exchange.h"
#include "tests/support/random_objects.h"
#include "tests/support/volume_where.h"

namespace bccskel::rank_skeletonize {
namespace {

using testing::HasSubstr;

constexpr int kRanks[] = {1, 2, 5};  // more in rank_peeling_test.cc

absl::StatusOr<SkeletonizeResult> OnRanks(const Volume& object, const SkeletonizeOptions& options,
                                          int ranks, const std::stop_token& stop_of_last = {}) {
  absl::StatusOr<SkeletonizeResult> result = absl::UnknownError("nobody has led");
  ranks::RunAsThreads(ranks, [&](ranks::Exchange& exchange) {
    exec::Context context;
    if (exchange.rank() == ranks - 1) context.stop = stop_of_last;
    const LayerPart part = {exchange.rank(), exchange.size()};
    Volume own = OnlyLayers(object, part);
    if (exchange.rank() != 0) {
      (void)ranks::FollowLead(exchange, context, std::move(own));
      return;
    }
    ranks::Lead lead(exchange);
    result = lead.Skeletonize(own, options, context);
    if (result.ok() && !options.preparing.Wanted()) {
      EXPECT_EQ(own, object);
    }
  });
  return result;
}

void ExpectSame(const Volume& object, const SkeletonizeOptions& options,
                std::span<const int> numbers_of_ranks = kRanks) {
  const auto wanted = Skeletonize(object, options, {});
  ASSERT_TRUE(wanted.ok()) << wanted.status();
  for (const int ranks : numbers_of_ranks) {
    SCOPED_TRACE(ranks);
    const auto got = OnRanks(object, options, ranks);
    ASSERT_TRUE(got.ok()) << got.status();
    EXPECT_EQ(got->graph, wanted->graph);
    EXPECT_EQ(got->thin, wanted->thin);
    EXPECT_EQ(got->certificate, wanted->certificate);
    EXPECT_EQ(got->sha256, wanted->sha256);
    EXPECT_EQ(got->object_points, wanted->object_points);
    EXPECT_EQ(got->last_shell, wanted->last_shell);
  }
}

std::vector<Volume> Objects() {
  std::vector<Volume> objects;
  for (uint64_t seed = 0; seed < 2; ++seed) {
    const auto blob = test::RandomBlob(seed, {50, 50, 50}, 10, 14);
    objects.push_back(VolumeOfPoints(test::WithNoisyBoundary(seed, blob, 0.05)));
    objects.push_back(VolumeOfPoints(test::RandomCloud(seed, {40, 30, 20}, 0.6)));
    objects.push_back(VolumeOfPoints(test::RandomCloud(seed, {90, 40, 2}, 0.8)));
  }
  return objects;
}

// One number of ranks an object, in turns: the two objects of a kind meet two of them.
void ExpectSameOfObjects(const SkeletonizeOptions& options) {
  size_t n = 0;
  for (const Volume& object : Objects()) {
    ExpectSame(object, options, std::span(kRanks).subspan((n + n / 3) % 3, 1));
    ++n;
  }
}

TEST(RankSkeletonize, DefaultsGiveTheResultOfOneMachine) {
  for (const Volume& object : Objects()) ExpectSame(object, {});
}

TEST(RankSkeletonize, TheDirectionalMethodGivesTheResultOfOneMachine) {
  ExpectSameOfObjects({.thinning = {.method = ThinningMethod::kDirectional}});
}

TEST(RankSkeletonize, ChamferDistancesGiveTheResultOfOneMachine) {
  ExpectSameOfObjects({.distance = DistanceKind::kChamfer});
  ExpectSameOfObjects({.thinning = {.method = ThinningMethod::kDirectional},
                       .distance = DistanceKind::kChamferOptimal});
}

TEST(RankSkeletonize, KindsGiveTheResultOfOneMachine) {
  for (const SkeletonKind kind :
       {SkeletonKind::kSurface, SkeletonKind::kKernel, SkeletonKind::kIsthmusCurve}) {
    SCOPED_TRACE(static_cast<int>(kind));
    ExpectSameOfObjects({.thinning = {.method = ThinningMethod::kSymmetric, .kind = kind}});
  }
}

TEST(RankSkeletonize, UnequalSpacingGivesTheResultOfOneMachine) {
  for (const Volume& object : Objects()) {
    const Volume stretched = Volume::FromSortedBricks(
        object.extent(), {.spacing = {0.3, 0.7, 1.1}}, {object.keys().begin(), object.keys().end()},
        {object.bricks().begin(), object.bricks().end()});
    ExpectSame(stretched, {});
  }
}

TEST(RankSkeletonize, PreparingGivesTheResultOfOneMachine) {
  SkeletonizeOptions options;
  options.preparing.cavities = CavityFilling::kOn;
  ExpectSameOfObjects(options);
}

// Its distances need more than 16 bits.
TEST(RankSkeletonize, ADeepObjectGivesTheResultOfOneMachine) {
  const Volume object = test::FullBricks(272 / kBrickX, 272 / kBrickY, 272 / kBrickZ);
  for (const DistanceKind kind : {DistanceKind::kEuclidean, DistanceKind::kChamfer}) {
    const SkeletonizeOptions options = {
        .thinning = {.method = ThinningMethod::kSymmetric, .kind = SkeletonKind::kKernel},
        .distance = kind};
    const auto wanted = Skeletonize(object, options, {});
    ASSERT_TRUE(wanted.ok());
    EXPECT_EQ(OnRanks(object, options, 3)->sha256, wanted->sha256);
  }
}

// Whose distances are those in the slice.
TEST(RankSkeletonize, MasksOfOneSliceGiveTheResultOfOneMachine) {
  const Volume object = test::VolumeWhere({60, 70, 2}, [](double x, double y, double z) {
    return std::min(std::abs(x - 60), std::abs(y - 70)) <= 9 && z <= 2;
  });
  const SkeletonizeOptions options = {.source = ObjectSource::kVoxels};
  EXPECT_GT(Skeletonize(object, options, {})->graph.points.front().radius, 4);
  ExpectSame(object, options);
}

TEST(RankSkeletonize, OptionsThatRanksCannotKeepToAreRefused) {
  const Volume object = Objects().front();
  EXPECT_THAT(std::string(OnRanks(object, {.border = Border::kContinues}, 2).status().message()),
              HasSubstr("--border"));
}

// Two ranks, of which this one counts its messages.
class CountingExchange : public ranks::Exchange {
 public:
  int rank() const override { return 0; }
  int size() const override { return 2; }
  void Trade(std::span<const int>, std::span<const ranks::Bytes>,
             std::span<ranks::Bytes>) override {
    ++messages;
  }
  void Sum(std::span<uint64_t>) override { throw std::bad_alloc(); }
  void Max(std::span<uint64_t>) override { throw std::bad_alloc(); }

  int messages = 0;
};

// The others wait for its sum, so a message would wait for them.
TEST(RankSkeletonize, ALeadWithoutMemorySendsNothingMore) {
  CountingExchange exchange;
  try {
    ranks::Lead lead(exchange);
    uint64_t number = 1;
    exchange.Sum({&number, 1});
    FAIL();
  } catch (const std::bad_alloc&) {
    EXPECT_EQ(exchange.messages, 0);
  }
  { const ranks::Lead lead(exchange); }
  EXPECT_EQ(exchange.messages, 1);
}

TEST(RankSkeletonize, AStopOnAnyRankStopsAll) {
  std::stop_source source;
  source.request_stop();
  const auto result = OnRanks(Objects().front(), {}, 3, source.get_token());
  EXPECT_EQ(result.status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace bccskel::rank_skeletonize
