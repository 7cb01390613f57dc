#include "core/exec/read_ahead.h"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <vector>

namespace bccskel::exec {
namespace {

constexpr size_t kParts = 50;

class ReadAheadTest : public testing::TestWithParam<int> {
 protected:
  ReadAheadTest() : team_(GetParam()) { context_.team = &team_; }

  // Reads parts and notes what was used; errors where asked for.
  absl::Status Run(size_t parts, size_t unreadable = kParts, size_t unusable = kParts) {
    return ReadAhead<size_t>(
        context_, parts,
        [&, unreadable](size_t n, size_t& room) {
          EXPECT_EQ(n, read_++);
          if (n == unreadable) return absl::DataLossError("read");
          room = n;
          return absl::OkStatus();
        },
        [&, unusable](size_t n, size_t& room) {
          EXPECT_EQ(room, n);
          if (n == unusable) return absl::InternalError("use");
          used_.push_back(n);
          return absl::OkStatus();
        });
  }

  static std::vector<size_t> FirstOf(size_t count) {
    std::vector<size_t> parts(count);
    std::iota(parts.begin(), parts.end(), size_t{0});
    return parts;
  }

  WorkerTeam team_;
  Context context_;
  size_t read_ = 0;
  std::vector<size_t> used_;
};

TEST_P(ReadAheadTest, ReadsAndUsesEachPartOnceInOrder) {
  for (const size_t parts : {size_t{0}, size_t{1}, size_t{2}, kParts}) {
    read_ = 0;
    used_.clear();
    ASSERT_TRUE(Run(parts).ok());
    EXPECT_EQ(read_, parts);
    EXPECT_EQ(used_, FirstOf(parts));
  }
}

TEST_P(ReadAheadTest, UsesWhatWasReadBeforeAnError) {
  EXPECT_TRUE(absl::IsDataLoss(Run(kParts, 7)));
  EXPECT_EQ(used_, FirstOf(7));
}

TEST_P(ReadAheadTest, StopsAtTheFirstPartThatCannotBeUsed) {
  EXPECT_TRUE(absl::IsInternal(Run(kParts, 8, 7)));
  EXPECT_EQ(used_, FirstOf(7));
  EXPECT_LE(read_, size_t{9});
}

TEST_P(ReadAheadTest, PassesExceptionsOn) {
  const auto read = [](size_t /*n*/, int& /*room*/) { return absl::OkStatus(); };
  const auto use = [](size_t n, int& /*room*/) {
    if (n == 3) throw std::runtime_error("use");
    return absl::OkStatus();
  };
  EXPECT_THROW(ReadAhead<int>(context_, kParts, read, use).IgnoreError(), std::runtime_error);
}

INSTANTIATE_TEST_SUITE_P(Threads, ReadAheadTest, testing::Values(1, 2, 5));

}  // namespace
}  // namespace bccskel::exec
