#include <gtest/gtest.h>

#include <functional>
#include <utility>
#include <vector>

#include "client/skeletonize_client.h"
#include "core/import/shapes/shapes.h"
#include "proto/wire/result.h"
#include "proto/wire/skeleton_chunks.h"
#include "tests/client/support/fake_server.h"

// One attempt at a call with labels, against a server that may lie.

namespace bccskel::client::labels_stub {
namespace {

using Reply = v1::SkeletonizeLabelsResponse;
using Replies = std::vector<Reply>;

const SkeletonizeResult& Torus() {
  static const SkeletonizeResult result =
      *Skeletonize(*GenerateShape(Shape::kTorus, {.points = 5000}), {}, {});
  return result;
}

void AddLabel(uint64_t label, Replies& replies) {
  wire::SkeletonChunkPager pager(Torus().graph);
  while (auto chunk = pager.Next()) {
    v1::LabelSkeletonChunk& message = *replies.emplace_back().mutable_skeleton_chunk();
    message.set_label(label);
    *message.mutable_chunk() = *std::move(chunk);
  }
  v1::LabelSummary& summary = *replies.emplace_back().mutable_label_summary();
  summary.set_label(label);
  *summary.mutable_summary() = wire::SummaryOf(Torus(), {});
}

// Accepted, two labels with a chunk each, the summary of all.
Replies HonestReplies() {
  Replies replies(1);
  replies[0].mutable_accepted()->set_max_chunk_bytes(1000);
  AddLabel(4, replies);
  AddLabel(9, replies);
  replies.emplace_back().mutable_labels_summary()->set_labels(2);
  return replies;
}

absl::StatusOr<LabelsReport> ReportAfter(const std::function<void(Replies&)>& damage) {
  const FakeServer server([&](FakeServer::LabelsStream& stream) {
    Replies replies = HonestReplies();
    damage(replies);
    v1::SkeletonizeLabelsRequest config;
    stream.Read(&config);
    for (const Reply& reply : replies) stream.Write(reply);
    for (v1::SkeletonizeLabelsRequest rest; stream.Read(&rest);) continue;
    return grpc::Status::OK;
  });
  EncodedLabels labels;
  labels.bytes = "x";
  return MakeGrpcStub(server.address())
      ->SkeletonizeLabels(
          labels, {}, [](LabelSkeleton&&) { return absl::OkStatus(); },
          Stub::Clock::now() + std::chrono::minutes(2));
}

TEST(LabelsStub, TakesWhatAnHonestServerSends) {
  const auto report = ReportAfter([](Replies&) {});
  ASSERT_TRUE(report.ok()) << report.status();
  EXPECT_EQ(report->labels, 2u);
}

TEST(LabelsStub, ReportsACallThatTheServerCancelsAsUnavailable) {
  const FakeServer server([](FakeServer::LabelsStream&) {
    return grpc::Status(grpc::StatusCode::CANCELLED, "about to stop");
  });
  EncodedLabels labels;
  labels.bytes = "x";
  const auto report = MakeGrpcStub(server.address())
                          ->SkeletonizeLabels(
                              labels, {}, [](LabelSkeleton&&) { return absl::OkStatus(); },
                              Stub::Clock::now() + std::chrono::minutes(2));
  EXPECT_TRUE(absl::IsUnavailable(report.status())) << report.status();
}

// Each damage must be noticed; the name says what a user would otherwise get.
struct Damage {
  const char* name;
  std::function<void(Replies&)> apply;
};

class DamagedLabels : public testing::TestWithParam<Damage> {};

TEST_P(DamagedLabels, AreDataLoss) {
  const auto report = ReportAfter(GetParam().apply);
  EXPECT_TRUE(absl::IsDataLoss(report.status())) << report.status();
}

INSTANTIATE_TEST_SUITE_P(
    Every, DamagedLabels,
    testing::Values(Damage{"not_accepted", [](Replies& r) { r.erase(r.begin()); }},
                    Damage{"accepted_twice", [](Replies& r) { r.insert(r.begin(), r.front()); }},
                    Damage{"no_summary", [](Replies& r) { r.pop_back(); }},
                    Damage{"label_missing",
                           [](Replies& r) { r.erase(r.begin() + 1, r.begin() + 3); }},
                    Damage{"label_twice",
                           [](Replies& r) {
                             r.insert(r.begin() + 3, {Reply(r[1]), Reply(r[2])});
                           }},
                    Damage{"labels_swapped",
                           [](Replies& r) {
                             std::swap(r[1], r[3]);
                             std::swap(r[2], r[4]);
                           }},
                    Damage{"chunk_missing", [](Replies& r) { r.erase(r.begin() + 1); }},
                    Damage{"chunk_of_another_label",
                           [](Replies& r) { r[1].mutable_skeleton_chunk()->set_label(9); }},
                    Damage{"label_without_its_end", [](Replies& r) { r.erase(r.begin() + 2); }},
                    Damage{"point_moved",
                           [](Replies& r) {
                             auto& points =
                                 *r[1].mutable_skeleton_chunk()->mutable_chunk()->mutable_points();
                             points.set_x(1, points.x(1) + 2);
                           }}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace bccskel::client::labels_stub
