#include "client/export/skeleton_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stop_token>

#include "client/export/graph_formats.h"
#include "client/export/json.h"
#include "core/io/volume_file.h"
#include "tests/client/export/sample_skeletons.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::exporting {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class SkeletonFileTest : public testing::Test {
 protected:
  std::string Written(const std::string& name, const Sample& sample) const {
    const auto note = WriteSkeletonFile(folder_ / name, {sample.result, sample.object, "A title"});
    EXPECT_TRUE(note.ok()) << note.status();
    return test::BytesOfFile(folder_ / name);
  }

  const test::TemporaryFolder folder_;
};

TEST_F(SkeletonFileTest, TheEndingChoosesTheFormatInCapitalsOrNot) {
  EXPECT_EQ(*SkeletonFormatOf("a.swc"), SkeletonFormat::kSwc);
  EXPECT_EQ(*SkeletonFormatOf("/x.y/A.GraphML"), SkeletonFormat::kGraphMl);
  EXPECT_EQ(*SkeletonFormatOf("a.exr"), SkeletonFormat::kVolume);
  EXPECT_EQ(*SkeletonFormatOf("a.bccb"), SkeletonFormat::kVolume);
  EXPECT_EQ(*SkeletonFormatOf("a.mrk.json"), SkeletonFormat::kMarkups);
  EXPECT_EQ(*SkeletonFormatOf("a.precomputed/"), SkeletonFormat::kPrecomputed);
  EXPECT_EQ(*SkeletonFormatOf("amrk.json"), SkeletonFormat::kJson);
  const auto unknown = SkeletonFormatOf("a.docx");
  EXPECT_TRUE(absl::IsInvalidArgument(unknown.status()));
  EXPECT_THAT(std::string(unknown.status().message()), HasSubstr(SkeletonFormatEndings()));
}

TEST_F(SkeletonFileTest, EqualSubjectsGiveEqualBytes) {
  const Sample sample = SampleOf(Shape::kKnot);
  for (const char* name : {"a.swc", "a.vtp", "a.graphml", "a.obj", "a.json", "a.csv", "a.mrk.json",
                           "a.glb", "a.exr", "a.bccb", "a.svg", "a.html"}) {
    const std::string first = Written(name, sample);
    EXPECT_FALSE(first.empty()) << name;
    EXPECT_TRUE(first == Written(name, sample)) << name;
  }
}

// Programs that use the library without that of pictures leave `draw` out.
TEST_F(SkeletonFileTest, PicturesNeedSomeoneWhoDrawsThem) {
  const Sample sample = SampleOf(Shape::kTree);
  Subject subject = {sample.result, sample.object, "title"};
  const absl::Status refused = WriteSkeletonFile(folder_ / "a.png", subject).status();
  EXPECT_TRUE(absl::IsUnimplemented(refused)) << refused;
  EXPECT_THAT(std::string(refused.message()), HasSubstr("bccskel render"));
  EXPECT_FALSE(fs::exists(folder_ / "a.png"));
  subject.draw = [](const Subject& drawn) -> absl::StatusOr<std::string> { return drawn.title; };
  EXPECT_TRUE(WriteSkeletonFile(folder_ / "a.png", subject).ok());
  EXPECT_EQ(fs::file_size(folder_ / "a.png"), subject.title.size());
}

TEST_F(SkeletonFileTest, VolumesReadBackToTheThinnedObject) {
  const Sample sample = SampleOf(Shape::kTree);
  for (const char* name : {"thin.exr", "thin.bccb"}) {
    Written(name, sample);
    const auto read = ReadVolumeFile(folder_ / name);
    ASSERT_TRUE(read.ok()) << read.status();
    EXPECT_EQ(*read, sample.result.thin) << name;
  }
}

TEST_F(SkeletonFileTest, TellsWhatTheFormatCouldNotHold) {
  const Sample sample = SampleOf(Shape::kTorus);
  const Subject subject = {sample.result, sample.object, ""};
  EXPECT_THAT(*WriteSkeletonFile(folder_ / "a.swc", subject), HasSubstr("1 loop cut"));
  EXPECT_EQ(*WriteSkeletonFile(folder_ / "a.vtp", subject), "");
}

TEST_F(SkeletonFileTest, CoordinatesThatOverflowAreRefusedAndNothingIsWritten) {
  Sample sample = SampleOf(Shape::kTorus);
  sample.result.graph.placement.spacing = {1e308, 1e308, 1e308};
  const auto note = WriteSkeletonFile(folder_ / "a.json", {sample.result, sample.object, "title"});
  EXPECT_TRUE(absl::IsInvalidArgument(note.status())) << note.status();
  EXPECT_FALSE(fs::exists(folder_ / "a.json"));
}

TEST_F(SkeletonFileTest, AStopLeavesNoFileAndTheOldOnes) {
  const Sample sample = SampleOf(Shape::kKnot);
  const std::string kept = folder_ / "old.precomputed";
  ASSERT_TRUE(WriteSkeletonFile(kept, {sample.result, sample.object, "old"}).ok());
  std::ofstream(kept + "/1") << "old";
  std::stop_source stop;
  stop.request_stop();
  Subject subject = {sample.result, sample.object, "title"};
  subject.context.stop = stop.get_token();
  for (const char* name :
       {"a.swc", "a.vtp", "a.graphml", "a.obj", "a.json", "a.csv", "a.mrk.json", "a.glb", "a.exr",
        "a.bccb", "a.svg", "a.html", "a.precomputed", "old.precomputed"}) {
    const absl::Status status = WriteSkeletonFile(folder_ / name, subject).status();
    EXPECT_TRUE(absl::IsCancelled(status)) << name << ": " << status;
    EXPECT_EQ(folder_.Count(), 1) << name;
  }
  EXPECT_EQ(fs::file_size(kept + "/1"), 3u);
  EXPECT_EQ(std::distance(fs::directory_iterator(kept), {}), 2);
}

// Composing the text of a large graph takes seconds.
TEST(ComposingTest, EndsAfterAStop) {
  const Sample sample = SampleOf(Shape::kTree, 50'000);
  const SkeletonGraph& graph = sample.result.graph;
  std::stop_source stop;
  const auto sizes = [&] {
    const std::stop_token token = stop.get_token();
    exec::Context context_of_job;
    context_of_job.stop = token;
    const GraphContext context = {.labels = {}, .facts = {}, .order = {}, .exec = context_of_job};
    return std::vector<size_t>{
        WriteSwc(graph, std::nullopt, {.sampling = {}, .facts = {}, .stop = token}).text.size(),
        VtpText(graph, context).size(),
        GraphMlText(graph, context).size(),
        ObjText(graph, context).size(),
        JsonText(sample.result, std::nullopt, {}, JsonParts::kAll, context_of_job).size(),
        BranchTableText(graph, context).size(),
        WriteMarkups(graph, context, {}).text.size(),
        WriteGlb(graph, context)->text.size()};
  };
  const std::vector<size_t> whole = sizes();
  stop.request_stop();
  const std::vector<size_t> stopped = sizes();
  for (size_t n = 0; n < whole.size(); ++n) EXPECT_LT(4 * stopped[n], whole[n]) << n;
}

}  // namespace
}  // namespace bccskel::exporting
