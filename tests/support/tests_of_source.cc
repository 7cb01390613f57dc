// The main() of programs that hold the tests of several sources. `--source=a_test.cc` runs those of
// that source only, and fails where it has none.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>
#include <string>
#include <string_view>

namespace {

// A filter of GoogleTest; empty without tests.
std::string TestsOf(std::string_view source) {
  const std::string ending = "/" + std::string(source);
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  std::string filter;
  for (int s = 0; s < all.total_test_suite_count(); ++s) {
    const testing::TestSuite& suite = *all.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const testing::TestInfo& test = *suite.GetTestInfo(t);
      if (!std::string_view(test.file()).ends_with(ending)) continue;
      filter += std::string(suite.name()) + "." + test.name() + ":";
    }
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  constexpr std::string_view kOption = "--source=";
  if (argc == 2 && std::string_view(argv[1]).starts_with(kOption)) {
    const std::string filter = TestsOf(std::string_view(argv[1]).substr(kOption.size()));
    if (filter.empty()) {
      std::cerr << argv[0] << ": no tests for " << argv[1] << '\n';
      return 1;
    }
    GTEST_FLAG_SET(filter, filter);
  }
  return RUN_ALL_TESTS();
}
