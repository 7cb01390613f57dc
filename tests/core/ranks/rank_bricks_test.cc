#include "core/ranks/rank_bricks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/import/shapes/shapes.h"
#include "tests/core/ranks/thread_exchange.h"
#include "tests/support/object_parts.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

using testing::HasSubstr;

std::vector<Volume> Shared(int ranks, const std::function<Volume(int)>& part_of) {
  std::vector<Volume> shared(static_cast<size_t>(ranks));
  ranks::RunAsThreads(ranks, [&](ranks::Exchange& exchange) {
    auto own = ranks::ShareEvenly(exchange, part_of(exchange.rank()));
    ASSERT_TRUE(own.ok()) << own.status();
    shared[static_cast<size_t>(exchange.rank())] = *std::move(own);
  });
  return shared;
}

void ExpectEvenRuns(const std::vector<Volume>& shared, const Volume& object) {
  EXPECT_EQ(*test::Joined(shared), object);
  for (size_t rank = 0; rank < shared.size(); ++rank) {
    const exec::Share share = exec::ShareOf(object.brick_count(), static_cast<int>(rank),
                                            static_cast<int>(shared.size()));
    ASSERT_EQ(shared[rank].brick_count(), share.end - share.begin);
    EXPECT_TRUE(std::ranges::equal(shared[rank].keys(),
                                   object.keys().subspan(share.begin, share.end - share.begin)));
  }
}

TEST(ShareEvenly, GivesEachRankTheNextRunOfBricksWhoeverHadThem) {
  const std::vector<Volume> objects = {VolumeOfPoints(test::RandomCloud(1, {200, 100, 100}, 0.01)),
                                       VolumeOfPoints(test::RandomCloud(2, {300, 200, 4}, 0.01)),
                                       *GenerateShape(Shape::kTree, {.points = 60'000}),
                                       VolumeOfPoints(test::RandomCloud(3, {3, 3, 3}, 0.7)),
                                       Volume::FromSortedBricks({4, 4, 4}, {}, {}, {})};
  for (const Volume& object : objects) {
    for (const int ranks : {1, 2, 3, 5, 8, 13}) {
      SCOPED_TRACE(ranks);
      const Volume nothing = Volume::FromSortedBricks(object.extent(), object.placement(), {}, {});
      ExpectEvenRuns(Shared(ranks,
                            [&](int rank) {
                              return OnlyLayers(object, {rank, ranks});
                            }),
                     object);
      ExpectEvenRuns(Shared(ranks, [&](int rank) { return rank == ranks - 1 ? object : nothing; }),
                     object);
    }
  }
}

TEST(ShareEvenly, RefusesABrickThatTwoRanksHave) {
  const Volume object = VolumeOfPoints(test::RandomCloud(4, {60, 60, 60}, 0.1));
  ranks::RunAsThreads(3, [&](ranks::Exchange& exchange) {
    const auto own = ranks::ShareEvenly(exchange, object);
    EXPECT_FALSE(own.ok());
    if (exchange.rank() == 0) {
      EXPECT_THAT(std::string(own.status().message()), HasSubstr("given twice"));
    }
  });
}

}  // namespace
}  // namespace bccskel
