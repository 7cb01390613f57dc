#include "client/view/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "client/export/json.h"
#include "tests/client/export/sample_skeletons.h"

namespace bccskel::view {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string PageFor(const exporting::Sample& sample, const std::string& title) {
  const auto result = ParseResultDocument(exporting::JsonText(sample.result));
  const auto peeling = PeelForDisplay(sample.object, {}, {});
  return *PageOf({title, *result, *peeling});
}

TEST(PageTest, IsWholeAndAsksForNothingElse) {
  for (const exporting::Sample& sample : exporting::Samples()) {
    const std::string page = PageFor(sample, "a title");
    EXPECT_THAT(page, HasSubstr("</html>"));
    for (const char* request : {"{{", "src=", "href=\"http", "@import", "url(", "fetch("}) {
      EXPECT_THAT(page, Not(HasSubstr(request)));
    }
  }
}

TEST(PageTest, ShowsTheSkeletonAloneWhereThereIsNoObject) {
  const exporting::Sample sample = exporting::SampleOf(Shape::kTree);
  const auto result = ParseResultDocument(exporting::JsonText(sample.result));
  const std::string page = *PageOf({"alone", *result, {}});
  EXPECT_THAT(page, HasSubstr("\"layers\":[]"));
  EXPECT_THAT(page, HasSubstr("</html>"));
}

TEST(PageTest, OfAnEmptyObjectIsThere) {
  EXPECT_THAT(PageFor(exporting::Sample(), "nothing"), HasSubstr("</html>"));
}

TEST(PageTest, CarriesTheLicenseOfThreeJs) {
  const std::string page = PageFor(exporting::SampleOf(Shape::kTorus), "");
  EXPECT_THAT(page, HasSubstr("The MIT License"));
  EXPECT_THAT(page, HasSubstr("three.js authors"));
  EXPECT_THAT(page, HasSubstr("THE SOFTWARE IS PROVIDED \"AS IS\""));
}

TEST(PageTest, OpensWithTheViewThatPicturesHave) {
  exporting::Sample sample = exporting::SampleOf(Shape::kTorus);
  EXPECT_THAT(PageFor(sample, ""), HasSubstr("\"turn\":30.0,\"climb\":15.0"));
  sample.result.options.source = ObjectSource::kVoxels;
  sample.result.options.voxel_slabs = {1, 1, 1000};  // the object is one slice
  EXPECT_THAT(PageFor(sample, ""), HasSubstr("\"turn\":0.0,\"climb\":0.0"));
}

TEST(PageTest, NoTitleAndNoResultEndsItsScript) {
  exporting::Sample sample = exporting::SampleOf(Shape::kTorus);
  sample.result.sha256 = "</script><b>";
  const std::string page = PageFor(sample, "</script>\xff{{viewer}}");
  EXPECT_THAT(page, Not(HasSubstr("</script><b>")));
  EXPECT_THAT(page, HasSubstr("\\u003c/script>\xef\xbf\xbd{{viewer}}"));
}

TEST(PageTest, IsTheSameForTheSameContentHoweverLongItTook) {
  exporting::Sample sample = exporting::SampleOf(Shape::kTree);
  const std::string page = PageFor(sample, "x");
  sample.result.timings.total += std::chrono::seconds(1);
  EXPECT_EQ(page, PageFor(sample, "x"));
}

}  // namespace
}  // namespace bccskel::view
