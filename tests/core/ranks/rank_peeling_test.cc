#include "core/ranks/rank_peeling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/distance/distance_field.h"
#include "core/volume/layer_part.h"
#include "tests/core/ranks/thread_exchange.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/volume_where.h"

namespace bccskel::rank_peeling {
namespace {

constexpr int kRanks[] = {1, 2, 3, 5, 8};

struct Named {
  std::string name;
  Volume volume;
};

std::vector<LatticePoint> Grid(LatticeExtent extent, int every) {
  std::vector<LatticePoint> points;
  for (Sublattice sublattice : kSublattices) {
    for (int k = 0; k < extent.nz; ++k) {
      for (int j = 0; j < extent.ny; ++j) {
        for (int i = 0; i < extent.nx; ++i) {
          const int on =
              (i % every < 3 ? 1 : 0) + (j % every < 3 ? 1 : 0) + (k % every < 3 ? 1 : 0);
          if (on >= 2) points.push_back(PointAt(sublattice, i, j, k));
        }
      }
    }
  }
  return points;
}

std::vector<Named> ObjectsOf(uint64_t seed) {
  std::vector<Named> objects;
  const auto add = [&](const std::string& name, const std::vector<LatticePoint>& points) {
    objects.push_back({name + " " + std::to_string(seed), VolumeOfPoints(points)});
  };
  const auto blob = test::RandomBlob(seed, {40, 40, 40}, 12, 14);
  add("blob", blob);
  add("noisy blob", test::WithNoisyBoundary(seed, blob, 0.05));
  add("dust", test::RandomCloud(seed, {70, 30, 30}, 0.03));
  add("foam", test::RandomCloud(seed, {40, 24, 24}, 0.5 + 0.05 * static_cast<double>(seed % 8)));
  add("sheet", test::RandomCloud(seed, {90, 60, 2}, 0.9));
  add("one layer", test::WithNoisyBoundary(seed, test::RandomBlob(seed, {80, 40, 5}, 9, 9), 0.1));
  add("net", test::RandomSubset(seed, Grid({60, 40, 30}, 9 + static_cast<int>(seed % 5)), 0.97));
  add("needle", test::RandomCloud(seed, {2, 2, 120}, 0.8));
  add("few bricks", test::RandomCloud(seed, {3, 3, 3}, 0.7));
  return objects;
}

ThinningResult OnOneMachine(const Volume& object, const ThinningOptions& options,
                            DistanceKind kind = DistanceKind::kEuclidean) {
  const auto distance = ComputeDistance(object, kind, {});
  auto result = ThinObject(object, *distance, options, {});
  EXPECT_TRUE(result.ok()) << result.status();
  return *std::move(result);
}

ThinningResult OnRanks(const Volume& object, const ThinningOptions& options, int ranks,
                       int threads = 1, DistanceKind kind = DistanceKind::kEuclidean) {
  ThinningResult result;
  ranks::RunAsThreads(ranks, [&](ranks::Exchange& exchange) {
    test::TeamContext context(threads);
    context.patience = 1e9;
    Volume part = OnlyLayers(object, {exchange.rank(), exchange.size()});
    auto peeled = ranks::PeelOverRanks(exchange, part, kind, options, {}, context);
    ASSERT_TRUE(peeled.ok()) << peeled.status();
    if (exchange.rank() != 0) return;
    EXPECT_EQ(part, object);
    EXPECT_EQ(peeled->points, object.PointCount());
    EXPECT_EQ(peeled->topology, *CountBettiNumbers(object, {}));
    result = std::move(peeled->thinned);
  });
  return result;
}

void ExpectSame(const ThinningResult& got, const ThinningResult& wanted) {
  EXPECT_EQ(got.thin, wanted.thin);
  EXPECT_EQ(got.isthmuses, wanted.isthmuses);
  EXPECT_EQ(got.last_shell, wanted.last_shell);
  EXPECT_EQ(got.removed, wanted.removed);
  EXPECT_EQ(got.removed_by_cleanup, wanted.removed_by_cleanup);
  EXPECT_EQ(got.passes, wanted.passes);
}

class Peeling : public testing::TestWithParam<uint64_t> {};

// Two numbers of ranks an object, in turns: over the seeds each kind of object meets all of them.
void ExpectSameOnRanks(const ThinningOptions& options, uint64_t seed,
                       DistanceKind kind = DistanceKind::kEuclidean) {
  size_t turn = seed;
  for (const Named& object : ObjectsOf(seed)) {
    const ThinningResult wanted = OnOneMachine(object.volume, options, kind);
    ++turn;
    for (const int ranks : {kRanks[turn % 5], kRanks[(turn + 2) % 5]}) {
      SCOPED_TRACE(object.name + " on " + std::to_string(ranks) + " ranks");
      ExpectSame(OnRanks(object.volume, options, ranks, 1, kind), wanted);
    }
  }
}

TEST_P(Peeling, SymmetricKindsAreThoseOfOneMachine) {
  for (const SkeletonKind kind : {SkeletonKind::kCurve, SkeletonKind::kSurface,
                                  SkeletonKind::kKernel, SkeletonKind::kIsthmusCurve}) {
    SCOPED_TRACE(static_cast<int>(kind));
    ExpectSameOnRanks({.method = ThinningMethod::kSymmetric, .kind = kind}, GetParam());
  }
}

TEST_P(Peeling, DirectionalMethodsAreThoseOfOneMachine) {
  for (const ThinningMethod method :
       {ThinningMethod::kDirectional, ThinningMethod::kDirectionalAlternating}) {
    SCOPED_TRACE(static_cast<int>(method));
    ExpectSameOnRanks({.method = method}, GetParam());
  }
}

TEST_P(Peeling, ChamferDistancesAreThoseOfOneMachine) {
  for (const ThinningMethod method : {ThinningMethod::kSymmetric, ThinningMethod::kDirectional}) {
    ExpectSameOnRanks({.method = method}, GetParam(), DistanceKind::kChamfer);
  }
  ExpectSameOnRanks({}, GetParam(), DistanceKind::kChamferOptimal);
}

TEST_P(Peeling, OptionsAreThoseOfOneMachine) {
  std::vector<LatticePoint> keep = {{0, 0, 0}};
  for (const LatticePoint p : test::RandomCloud(GetParam(), {40, 40, 40}, 0.001)) keep.push_back(p);
  for (const ThinningMethod method : {ThinningMethod::kSymmetric, ThinningMethod::kDirectional}) {
    ExpectSameOnRanks({.method = method, .stubble = StubblePolicy::kLiteral, .shell_width = 2},
                      GetParam());
    ExpectSameOnRanks({.method = method, .stubble = StubblePolicy::kNone, .last_shell = 2},
                      GetParam());
    ExpectSameOnRanks({.method = method, .keep = keep}, GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Peeling, testing::Range(uint64_t{1}, uint64_t{5}));

TEST(PeelOverRanks, ThreadsOfRanksDoNotMatter) {
  const Volume object =
      VolumeOfPoints(test::WithNoisyBoundary(7, test::RandomBlob(7, {60, 60, 60}, 20, 16), 0.05));
  for (const ThinningMethod method : {ThinningMethod::kSymmetric, ThinningMethod::kDirectional}) {
    const ThinningOptions options = {.method = method};
    const ThinningResult wanted = OnOneMachine(object, options);
    for (const int ranks : {1, 2, 3}) ExpectSame(OnRanks(object, options, ranks, 3), wanted);
  }
}

// Euclidean distances are measured a few thousand bricks at a time.
TEST(PeelOverRanks, SeveralRoundsOfColumnsMakeNoDifference) {
  const Volume object = VolumeOfPoints(test::RandomCloud(1, {600, 120, 80}, 0.004));
  ASSERT_GT(object.brick_count(), 15'000u);
  const ThinningResult wanted = OnOneMachine(object, {});
  for (const int ranks : {1, 2, 3}) ExpectSame(OnRanks(object, {}, ranks), wanted);
}

// Passes calls on, and remembers the most bytes that a call has sent while distances are measured.
class MeasuredExchange : public ranks::Exchange {
 public:
  explicit MeasuredExchange(ranks::Exchange& exchange) : exchange_(exchange) {}

  int rank() const override { return exchange_.rank(); }
  int size() const override { return exchange_.size(); }
  void Trade(std::span<const int> peers, std::span<const ranks::Bytes> out,
             std::span<ranks::Bytes> in) override {
    size_t bytes = 0;
    for (const ranks::Bytes& letter : out) bytes += letter.size();
    if (stage_ == ranks::Stage::kDistances) most_ = std::max(most_, bytes);
    exchange_.Trade(peers, out, in);
  }
  void Enter(ranks::Stage stage) override { stage_ = stage; }
  void Sum(std::span<uint64_t> numbers) override { exchange_.Sum(numbers); }
  void Max(std::span<uint64_t> numbers) override { exchange_.Max(numbers); }

  size_t most() const { return most_; }

 private:
  ranks::Exchange& exchange_;
  ranks::Stage stage_ = ranks::Stage::kSharing;
  size_t most_ = 0;
};

// All columns have one place along x, and so belong to one round.
TEST(PeelOverRanks, SquaresOfARoundAreSentLittleByLittle) {
  const Volume object = test::FullBricks(1, 272 / kBrickY, 272 / kBrickZ);
  ranks::RunAsThreads(2, [&](ranks::Exchange& exchange) {
    MeasuredExchange measured(exchange);
    Volume part = OnlyLayers(object, {exchange.rank(), exchange.size()});
    ASSERT_TRUE(ranks::PeelOverRanks(measured, part, DistanceKind::kEuclidean, {}, {}, {}).ok());
    EXPECT_LT(measured.most(), size_t{1} << 20);  // of 5 MiB
  });
}

TEST(PeelOverRanks, AnEmptyObjectStaysEmpty) {
  for (const int ranks : kRanks) {
    EXPECT_TRUE(OnRanks(Volume::FromSortedBricks({4, 4, 4}, {}, {}, {}), {}, ranks).thin.empty());
  }
}

}  // namespace
}  // namespace bccskel::rank_peeling
