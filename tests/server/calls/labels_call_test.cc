#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/io/byte_sink.h"
#include "core/io/encoded_body.h"
#include "tests/server/support/declared_labels.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

// One call, one volume of labels, one skeleton per label.

namespace bccskel {
namespace {

using test::Converse, test::DeclaredLabels, test::FiveLabels, test::LabelsReplies,
    test::SkeletonsOf;

void ExpectSame(const std::vector<LabelSkeleton>& found,
                const std::vector<LabelSkeleton>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (size_t n = 0; n < found.size(); ++n) {
    EXPECT_EQ(found[n].label, expected[n].label);
    EXPECT_EQ(found[n].voxels, expected[n].voxels);
    EXPECT_EQ(found[n].result.graph, expected[n].result.graph) << found[n].label;
    EXPECT_EQ(found[n].result.certificate, expected[n].result.certificate) << found[n].label;
    EXPECT_EQ(found[n].result.sha256, expected[n].result.sha256) << found[n].label;
    EXPECT_EQ(found[n].result.object_points, expected[n].result.object_points);
  }
}

const v1::LabelsSummary& SummaryOf(const LabelsReplies& replies) {
  return replies.responses.back().labels_summary();
}

class LabelsCall : public testing::Test {
 protected:
  LabelsReplies Call(const DeclaredLabels& labels, size_t chunk_bytes = 10'000) {
    return Converse(*server_, RequestsFor(labels, chunk_bytes));
  }
  void ExpectGives(const DeclaredLabels& labels, const std::vector<LabelSkeleton>& expected) {
    const auto replies = Call(labels);
    const auto skeletons = SkeletonsOf(replies);
    ASSERT_TRUE(skeletons.ok()) << skeletons.status();
    ExpectSame(*skeletons, expected);
  }

  std::unique_ptr<server::Server> server_ = test::StartServer();
};

TEST_F(LabelsCall, GivesForEachLabelWhatTheCoreGivesForAnyNumberOfThreads) {
  const std::vector<LabelSkeleton> expected = test::SkeletonsOf(FiveLabels());
  for (int threads : {0, 1, 2}) {
    DeclaredLabels labels = Declare(FiveLabels());
    labels.config.set_threads(threads);
    ExpectGives(labels, expected);
  }
}

TEST_F(LabelsCall, KeepsLabelsThatTouchApart) {
  const auto skeletons = SkeletonsOf(Call(Declare(FiveLabels())));
  ASSERT_TRUE(skeletons.ok()) << skeletons.status();
  const std::vector<BettiNumbers> betti = {{1, 1, 0}, {3, 0, 0}, {1, 0, 1}, {1, 0, 0}, {1, 0, 0}};
  const std::vector<uint64_t> ids = {test::kRing, test::kBar, test::kHollow, test::kBlob,
                                     test::kDot};
  ASSERT_EQ(skeletons->size(), ids.size());
  for (size_t n = 0; n < ids.size(); ++n) {
    const Certificate& certificate = (*skeletons)[n].result.certificate;
    EXPECT_EQ((*skeletons)[n].label, ids[n]);
    EXPECT_EQ(certificate.mask, betti[n]) << ids[n];
    EXPECT_EQ(certificate.input, betti[n]) << ids[n];
    EXPECT_EQ(certificate.skeleton, betti[n]) << ids[n];
  }
}

TEST_F(LabelsCall, SumsUpAndTellsTheProgress) {
  const auto replies = Call(Declare(FiveLabels()));
  const auto skeletons = SkeletonsOf(replies);
  ASSERT_TRUE(skeletons.ok()) << skeletons.status();
  uint64_t voxels = 0, points = 0;
  for (const LabelSkeleton& skeleton : *skeletons) {
    voxels += skeleton.voxels;
    points += skeleton.result.skeleton_points;
  }
  EXPECT_EQ(SummaryOf(replies).labels(), 5u);
  EXPECT_EQ(SummaryOf(replies).voxels(), voxels);
  EXPECT_EQ(SummaryOf(replies).skeleton_points(), points);
  EXPECT_FALSE(SummaryOf(replies).algorithm_version().empty());
  EXPECT_GE(SummaryOf(replies).threads(), 1);
  uint64_t done = 0;
  for (const auto& response : replies.responses) {
    if (!response.has_label_progress()) continue;
    EXPECT_EQ(response.label_progress().total(), 5u);
    EXPECT_GE(response.label_progress().done(), done);
    done = response.label_progress().done();
  }
  EXPECT_EQ(done, 5u);
}

TEST_F(LabelsCall, LeavesOutSmallLabelsAndSaysHowMany) {
  DeclaredLabels labels = Declare(FiveLabels());
  labels.config.set_min_voxels(65);  // the dot has 1, the blob 64
  ExpectGives(labels, test::SkeletonsOf(FiveLabels(), {.min_voxels = 65}));
  const auto replies = Call(labels);
  EXPECT_EQ(SummaryOf(replies).labels(), 3u);
  EXPECT_EQ(SummaryOf(replies).skipped(), 2u);
}

TEST_F(LabelsCall, TakesTheListedLabelsAndSaysHowManyAreAbsent) {
  DeclaredLabels labels = Declare(FiveLabels());
  for (uint64_t label : {test::kDot, test::kRing, uint64_t{4}, test::kBlob, test::kRing}) {
    labels.config.add_labels(label);
  }
  ExpectGives(labels,
              test::SkeletonsOf(FiveLabels(), {.labels = {test::kRing, test::kBlob, test::kDot}}));
  EXPECT_EQ(SummaryOf(Call(labels)).absent(), 1u);
}

TEST_F(LabelsCall, ReadsEveryType) {
  test::LabelImage image = FiveLabels();
  for (uint64_t& label : image.labels) label %= 251;
  const std::vector<LabelSkeleton> expected = test::SkeletonsOf(image);
  for (int bytes : {1, 2, 4, 8}) ExpectGives(Declare(image, bytes), expected);
}

std::string Zstd(const std::string& bytes) {
  StringSink sink;
  SinkCursor cursor(sink);
  BodyWriter writer(VolumeCompression::kZstd, cursor);
  EXPECT_TRUE(writer.Write(std::as_bytes(std::span(bytes))).ok());
  EXPECT_TRUE(writer.Finish().ok());
  return std::move(sink).Take();
}

TEST_F(LabelsCall, ReadsZstd) {
  DeclaredLabels labels = Declare(FiveLabels());
  labels.bytes = Zstd(labels.bytes);
  labels.config.mutable_volume()->set_compression(v1::VOLUME_COMPRESSION_ZSTD);
  labels.config.mutable_volume()->set_size_bytes(labels.bytes.size());
  ExpectGives(labels, test::SkeletonsOf(FiveLabels()));
}

TEST_F(LabelsCall, HandsOptionsOn) {
  DeclaredLabels labels = Declare(FiveLabels());
  labels.config.mutable_options()->set_stubble_policy(v1::STUBBLE_POLICY_NONE);
  labels.config.mutable_volume()->set_mask_adjacency(v1::MASK_ADJACENCY_OBJECT_6);
  LabelsOptions options;
  options.mask.adjacency = MaskAdjacency::k6;
  options.skeleton.thinning.stubble = StubblePolicy::kNone;
  ExpectGives(labels, test::SkeletonsOf(FiveLabels(), {}, options));
}

TEST_F(LabelsCall, AVolumeWithoutLabelsGivesASummaryAlone) {
  const auto replies = Call(Declare(test::LabelImage{
      .grid = {.nx = 5, .ny = 4, .nz = 3, .placement = {}}, .labels = std::vector<uint64_t>(60)}));
  const auto skeletons = SkeletonsOf(replies);
  ASSERT_TRUE(skeletons.ok()) << skeletons.status();
  EXPECT_TRUE(skeletons->empty());
  EXPECT_EQ(SummaryOf(replies).labels(), 0u);
}

TEST_F(LabelsCall, NeedsNoPromises) {
  DeclaredLabels labels = Declare(FiveLabels());
  v1::LabelVolumeDeclaration& volume = *labels.config.mutable_volume();
  volume.clear_max_voxels();
  volume.clear_max_label_voxels();
  volume.clear_max_runs();
  volume.clear_max_labels();
  ExpectGives(labels, test::SkeletonsOf(FiveLabels()));
}

}  // namespace
}  // namespace bccskel
