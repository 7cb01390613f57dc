#include "proto/wire/skeleton_chunks.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "proto/wire/result.h"
#include "tests/support/enum_values.h"

namespace bccskel::wire {
namespace {

constexpr uint32_t kLargest = std::numeric_limits<uint32_t>::max();
constexpr int32_t kFar = 2 * kMaxExtentCells - 1;

// `edges` edges of `length` points each in a chain of nodes. Coordinates and distances are as large
// as the format allows, so that chunks reach their largest size.
SkeletonGraph Chain(uint32_t edges, uint64_t length) {
  SkeletonGraph graph;
  graph.placement.origin = {1, 2, 3};
  const auto point = [](uint32_t n) {
    return SkeletonPoint{{kFar - static_cast<int32_t>(n % 1000), kFar, kFar},
                         static_cast<float>(kLargest - n)};
  };
  for (uint32_t n = 0; n <= edges; ++n) {
    graph.nodes.push_back({NodeKind::kJunction, point(n), kLargest - n, kLargest});
  }
  for (uint32_t n = 0; n < edges; ++n) {
    graph.edges.push_back({n, n + 1, graph.points.size(), length, n / 8.0});
    for (uint64_t step = 0; step + 1 < length; ++step) {
      graph.points.push_back(point(n + static_cast<uint32_t>(step % 7) * (step > 0)));
    }
    graph.points.push_back(point(n + 1));
  }
  return graph;
}

SkeletonGraph WithBirths(SkeletonGraph graph) {
  int32_t birth = std::numeric_limits<int32_t>::max();
  for (SkeletonNode& node : graph.nodes) node.at.birth = birth;
  for (SkeletonPoint& p : graph.points) p.birth = birth--;
  for (SkeletonPoint& p : graph.sheets) p.birth = birth--;
  return graph;
}

SkeletonGraph WithShifts(SkeletonGraph graph) {
  int16_t most = std::numeric_limits<int16_t>::max();
  for (SkeletonPoint& p : graph.points) p.shift = {most, 0, static_cast<int16_t>(-most)};
  return graph;
}

SkeletonGraph WithSheets(SkeletonGraph graph, uint32_t points) {
  for (uint32_t n = 0; n < points; ++n) {
    graph.sheets.push_back(
        {{kFar - static_cast<int32_t>(n % 1000), kFar, kFar}, static_cast<float>(kLargest - n)});
  }
  return graph;
}

std::vector<v1::SkeletonChunk> ChunksOf(const SkeletonGraph& graph) {
  std::vector<v1::SkeletonChunk> chunks;
  SkeletonChunkPager pager(graph);
  while (auto chunk = pager.Next()) chunks.push_back(*std::move(chunk));
  return chunks;
}

v1::SkeletonSummary SummaryFor(const SkeletonGraph& graph) {
  SkeletonizeResult result;
  result.graph = graph;
  result.sha256 = *SkeletonDigest(graph);
  return SummaryOf(result, {});
}

absl::StatusOr<SkeletonizeResult> Assemble(const std::vector<v1::SkeletonChunk>& chunks,
                                           const v1::SkeletonSummary& summary) {
  SkeletonAssembler assembler;
  for (const v1::SkeletonChunk& chunk : chunks) {
    if (absl::Status added = assembler.Add(chunk); !added.ok()) return added;
  }
  return std::move(assembler).Finish(summary);
}

void ExpectSurvives(const SkeletonGraph& graph) {
  const auto back = Assemble(ChunksOf(graph), SummaryFor(graph));
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->graph, graph);
}

TEST(SkeletonChunksRoundTrip, SmallGraph) { ExpectSurvives(Chain(3, 5)); }
TEST(SkeletonChunksRoundTrip, EmptyGraph) { ExpectSurvives(SkeletonGraph()); }
TEST(SkeletonChunksRoundTrip, ManyNodesAndShortEdges) { ExpectSurvives(Chain(30'000, 2)); }
TEST(SkeletonChunksRoundTrip, AnEdgeLongerThanAChunk) { ExpectSurvives(Chain(2, 50'000)); }
TEST(SkeletonChunksRoundTrip, Births) { ExpectSurvives(WithBirths(Chain(3, 5))); }
TEST(SkeletonChunksRoundTrip, BirthsOfNodesAlone) {
  SkeletonGraph graph;
  graph.nodes = {{NodeKind::kIsolated, {{2, 2, 2}, 1.5f, 3}}};
  ExpectSurvives(graph);
}
TEST(SkeletonChunksRoundTrip, Shifts) { ExpectSurvives(WithShifts(Chain(3, 5))); }

TEST(SkeletonChunksRoundTrip, Sheets) { ExpectSurvives(WithSheets(Chain(3, 5), 7)); }
TEST(SkeletonChunksRoundTrip, SheetsLongerThanAChunk) {
  ExpectSurvives(WithBirths(WithSheets(Chain(2, 3), 50'000)));
}
TEST(SkeletonChunksRoundTrip, SheetsWithoutEdges) {
  ExpectSurvives(WithSheets(SkeletonGraph(), 3));
}

TEST(SkeletonChunksRoundTrip, EveryKindOfNode) {
  SkeletonGraph graph;
  int32_t x = 0;
  for (NodeKind kind : test::ValuesOf<NodeKind>()) {
    graph.nodes.push_back({kind, {{x += 10, -3, 1}, 5}, 1, 2});
  }
  EXPECT_EQ(graph.nodes.size(),
            static_cast<size_t>(v1::SkeletonNodeKind_descriptor()->value_count() - 1));
  ExpectSurvives(graph);
}

TEST(SkeletonChunks, NeverPassTheirLimit) {
  for (const SkeletonGraph& graph :
       {Chain(30'000, 2), Chain(2, 50'000), Chain(3000, 9), WithBirths(Chain(30'000, 2)),
        WithShifts(WithBirths(Chain(2, 50'000))), WithBirths(WithSheets(Chain(2, 1000), 50'000))}) {
    const auto chunks = ChunksOf(graph);
    EXPECT_GT(chunks.size(), 1u);
    for (const v1::SkeletonChunk& chunk : chunks) {
      EXPECT_LE(chunk.ByteSizeLong(), kMaxSkeletonChunkBytes);
    }
  }
}

TEST(SkeletonChunks, HoldNoBirthsWhereThereAreNone) {
  for (const v1::SkeletonChunk& chunk : ChunksOf(Chain(3, 5))) {
    EXPECT_EQ(chunk.points().birth_size() + chunk.nodes().birth_size(), 0);
  }
}

TEST(SkeletonChunks, WithBirthsForSomePointsAreDataLoss) {
  const SkeletonGraph graph = WithBirths(Chain(3, 5));
  auto chunks = ChunksOf(graph);
  chunks[0].mutable_points()->mutable_birth()->RemoveLast();
  EXPECT_EQ(Assemble(chunks, SummaryFor(graph)).status().code(), absl::StatusCode::kDataLoss);
  chunks = ChunksOf(graph);
  chunks[0].mutable_nodes()->mutable_birth()->RemoveLast();
  EXPECT_EQ(Assemble(chunks, SummaryFor(graph)).status().code(), absl::StatusCode::kDataLoss);
}

TEST(SkeletonChunks, WithShiftsForSomePointsAreDataLoss) {
  const SkeletonGraph graph = WithShifts(Chain(3, 5));
  for (auto column :
       {&v1::SkeletonPointColumns::mutable_shift_x, &v1::SkeletonPointColumns::mutable_shift_y}) {
    auto chunks = ChunksOf(graph);
    (chunks[0].mutable_points()->*column)()->RemoveLast();
    EXPECT_EQ(Assemble(chunks, SummaryFor(graph)).status().code(), absl::StatusCode::kDataLoss);
  }
}

TEST(SkeletonChunks, AnEmptyGraphHasOneChunk) { EXPECT_EQ(ChunksOf(SkeletonGraph()).size(), 1u); }

using Damage = std::function<void(std::vector<v1::SkeletonChunk>&)>;
struct DamageCase {
  const char* name;
  Damage damage;
};

class DamagedSkeletonChunks : public testing::TestWithParam<DamageCase> {};

TEST_P(DamagedSkeletonChunks, AreDataLoss) {
  const SkeletonGraph graph = WithSheets(Chain(3, 5), 4);
  auto chunks = ChunksOf(graph);
  GetParam().damage(chunks);
  EXPECT_EQ(Assemble(chunks, SummaryFor(graph)).status().code(), absl::StatusCode::kDataLoss);
}

INSTANTIATE_TEST_SUITE_P(
    All, DamagedSkeletonChunks,
    testing::Values(
        DamageCase{"Missing", [](auto& c) { c.clear(); }},
        DamageCase{"Repeated", [](auto& c) { c.push_back(c[0]); }},
        DamageCase{"ShortColumn",
                   [](auto& c) { c[0].mutable_points()->mutable_x()->RemoveLast(); }},
        DamageCase{"ShortNodeColumn",
                   [](auto& c) { c[0].mutable_nodes()->mutable_loops()->RemoveLast(); }},
        DamageCase{"ShortEdgeColumn",
                   [](auto& c) { c[0].mutable_edges()->mutable_source()->RemoveLast(); }},
        DamageCase{
            "UnknownKind",
            [](auto& c) { c[0].mutable_nodes()->set_kind(0, v1::SKELETON_NODE_KIND_UNSPECIFIED); }},
        DamageCase{"EdgeToNowhere", [](auto& c) { c[0].mutable_edges()->set_target(0, 4); }},
        DamageCase{"EdgeOfTheWrongNode", [](auto& c) { c[0].mutable_edges()->set_target(0, 3); }},
        DamageCase{"EdgeWithoutPoints",
                   [](auto& c) {
                     c[0].mutable_edges()->set_point_count(0, 0);
                     c[0].mutable_edges()->set_point_count(1, 10);
                   }},
        DamageCase{"HugePointCount",
                   [](auto& c) {
                     c[0].mutable_edges()->set_point_count(0, uint64_t{1} << 63);
                     c[0].mutable_edges()->set_point_count(1, (uint64_t{1} << 63) + 10);
                   }},
        DamageCase{"ShortSheetColumn",
                   [](auto& c) { c[0].mutable_sheets()->mutable_x()->RemoveLast(); }},
        DamageCase{"MissingSheets", [](auto& c) { c[0].clear_sheets(); }},
        DamageCase{"OtherSheetRadius", [](auto& c) { c[0].mutable_sheets()->set_radius(2, 1); }},
        DamageCase{"OtherRadius", [](auto& c) { c[0].mutable_points()->set_radius(2, 1); }}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace bccskel::wire
