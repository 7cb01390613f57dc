#include "client/cli/option_values.h"

#include <gtest/gtest.h>

#include <string_view>
#include <utility>

namespace bccskel::cli {
namespace {

TEST(OptionValuesTest, MessagesNameOptionsAndTheirValuesAsPythonDoes) {
  const std::pair<std::string_view, std::string_view> kMessages[] = {
      {"--fill-cavities fills cavities", "fill_cavities fills cavities"},
      {"choose one with --channel 0 to 1", "choose one with channel=0 to 1"},
      {"winding number (--fill winding)", "winding number (fill=\"winding\")"},
      {"--fill fills", "fill fills"},
      {"--denoise 2 --min-component 200 smooths", "denoise=2, min_component=200 smooths"},
      {"or try --denoise 1, which", "or try denoise=1, which"},
      {"only skeletonize --range 0,0 selects", "only skeletonize() with range=(0, 0) selects"},
      {"(--join-gaps X joins components)", "(join_gaps=X joins components)"},
      {"--label 5-2: the first", "label=\"5-2\": the first"},
      {"--array 'a' is not there", "array='a' is not there"},
      {"--threshold 12.5 (Otsu's)", "threshold=12.5 (Otsu's)"},
      {"the command labels takes each", "skeletonize_labels() takes each"},
  };
  for (const auto& [message, expected] : kMessages) {
    EXPECT_EQ(WithOptionNames(message), expected);
  }
}

}  // namespace
}  // namespace bccskel::cli
