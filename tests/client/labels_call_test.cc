#include <gtest/gtest.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "client/skeletonize_client.h"
#include "server/server.h"
#include "tests/server/support/declared_labels.h"
#include "tests/server/support/running_server.h"

// The client library and a real server.

namespace bccskel::client {
namespace {

LabelVolume VolumeOf(const test::LabelImage& image) {
  return {.grid = image.grid, .label_bytes = 8, .voxels = std::as_bytes(std::span(image.labels))};
}

class LabelsCallTest : public testing::Test {
 protected:
  absl::StatusOr<LabelsReport> Call(const LabelsCallOptions& options) {
    return Call(options, [](const LabelSkeleton&) { return absl::OkStatus(); });
  }
  absl::StatusOr<LabelsReport> Call(
      const LabelsCallOptions& options,
      const std::function<absl::Status(const LabelSkeleton&)>& after_each) {
    return SkeletonizeClient(MakeGrpcStub(server_->address()))
        .SkeletonizeLabels(VolumeOf(test::FiveLabels()), options, [&](LabelSkeleton&& skeleton) {
          skeletons_.push_back(std::move(skeleton));
          return after_each(skeletons_.back());
        });
  }

  std::unique_ptr<server::Server> server_ = test::StartServer();
  std::vector<LabelSkeleton> skeletons_;
};

TEST_F(LabelsCallTest, GivesWhatTheCoreGives) {
  uint64_t done = 0, all = 0;
  const auto report = Call({.on_progress = [&](uint64_t now, uint64_t total) {
    done = now;
    all = total;
  }});
  ASSERT_TRUE(report.ok()) << report.status();
  const auto expected = test::SkeletonsOf(test::FiveLabels());
  ASSERT_EQ(skeletons_.size(), expected.size());
  for (size_t n = 0; n < expected.size(); ++n) {
    EXPECT_EQ(skeletons_[n].label, expected[n].label);
    EXPECT_EQ(skeletons_[n].voxels, expected[n].voxels);
    EXPECT_EQ(skeletons_[n].result.graph, expected[n].result.graph);
    EXPECT_EQ(skeletons_[n].result.certificate, expected[n].result.certificate);
  }
  EXPECT_EQ(report->labels, 5u);
  EXPECT_EQ(done, 5u);
  EXPECT_EQ(all, 5u);
}

TEST_F(LabelsCallTest, HandsChoicesOn) {
  LabelsCallOptions options;
  options.labels = {test::kDot, test::kHollow, 5};
  options.min_voxels = 2;
  options.threads = 1;
  const auto report = Call(options);
  ASSERT_TRUE(report.ok()) << report.status();
  ASSERT_EQ(skeletons_.size(), 1u);
  EXPECT_EQ(skeletons_[0].label, test::kHollow);
  EXPECT_EQ(report->skipped, 1u);
  EXPECT_EQ(report->absent, 1u);
}

TEST_F(LabelsCallTest, AConsumersErrorEndsTheCallAndTheJob) {
  const absl::Status full = absl::ResourceExhaustedError("the disk is full");
  EXPECT_EQ(Call({}, [&](const LabelSkeleton&) { return full; }).status(), full);
  EXPECT_EQ(skeletons_.size(), 1u);
  test::WaitUntilIdle(*server_);
}

TEST_F(LabelsCallTest, AStopEndsTheCallAndTheJob) {
  std::stop_source source;
  const auto report = Call({.stop = source.get_token()}, [&](const LabelSkeleton&) {
    source.request_stop();
    return absl::OkStatus();
  });
  EXPECT_TRUE(report.ok() || absl::IsCancelled(report.status())) << report.status();
  test::WaitUntilIdle(*server_);
}

TEST_F(LabelsCallTest, TheServersErrorComesWithItsText) {
  LabelsCallOptions options;
  options.skeletonize.thinning.shell_width = 0.1;
  const auto report = Call(options);
  EXPECT_TRUE(absl::IsInvalidArgument(report.status())) << report.status();
  EXPECT_TRUE(skeletons_.empty());
}

}  // namespace
}  // namespace bccskel::client
