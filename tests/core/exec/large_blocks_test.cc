#include "core/exec/large_blocks.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/exec/uninitialized.h"

namespace bccskel::exec {
namespace {

constexpr size_t kMiB = size_t{1} << 20;

TEST(LargeBlocks, HandOnABlockToTheNextWhoNeedsAboutAsMuch) {
  LargeBlocks blocks(64 * kMiB);
  void* first = blocks.Take(20 * kMiB - 1000);
  blocks.Give(first, 20 * kMiB - 1000);
  EXPECT_EQ(blocks.idle_bytes(), 20 * kMiB);
  void* second = blocks.Take(20 * kMiB - 5);
  EXPECT_EQ(second, first);
  EXPECT_EQ(blocks.idle_bytes(), 0);
  blocks.Give(second, 20 * kMiB - 5);
}

TEST(LargeBlocks, AreAsLargeAsWanted) {
  LargeBlocks blocks(0);
  for (size_t bytes : {kMiB, kMiB + 1, 2 * kMiB - 1, 3 * kMiB + 7, 17 * kMiB}) {
    void* block = blocks.Take(bytes);
    std::memset(block, 1, bytes);  // the sanitizer looks on
    blocks.Give(block, bytes);
  }
}

TEST(LargeBlocks, DoNotLendABlockTwice) {
  LargeBlocks blocks(64 * kMiB);
  blocks.Give(blocks.Take(kMiB), kMiB);
  void* one = blocks.Take(kMiB);
  void* other = blocks.Take(kMiB);
  EXPECT_NE(one, other);
  blocks.Give(one, kMiB);
  blocks.Give(other, kMiB);
}

TEST(LargeBlocks, KeepNoMoreIdleThanTheyMay) {
  LargeBlocks blocks(5 * kMiB);
  void* one = blocks.Take(3 * kMiB);
  void* other = blocks.Take(3 * kMiB);
  blocks.Give(one, 3 * kMiB);
  blocks.Give(other, 3 * kMiB);
  EXPECT_EQ(blocks.idle_bytes(), 3 * kMiB);
}

TEST(LargeBlocks, GiveBackWhatIsIdleForWhatIsTakenAnew) {
  LargeBlocks blocks(64 * kMiB);
  void* all[3];
  for (void*& block : all) block = blocks.Take(4 * kMiB);
  for (void* block : all) blocks.Give(block, 4 * kMiB);
  void* other = blocks.Take(6 * kMiB);  // of the twelve, eight go
  EXPECT_EQ(blocks.idle_bytes(), 4 * kMiB);
  blocks.Give(other, 6 * kMiB);
  EXPECT_EQ(blocks.idle_bytes(), 10 * kMiB);
}

TEST(LargeBlocks, ReleaseWhatNobodyHasUsedSinceTheLastCall) {
  LargeBlocks blocks(64 * kMiB);
  void* used = blocks.Take(2 * kMiB);
  blocks.Give(blocks.Take(4 * kMiB), 4 * kMiB);
  blocks.ReleaseUnused();
  EXPECT_EQ(blocks.idle_bytes(), 4 * kMiB);
  blocks.Give(used, 2 * kMiB);
  blocks.ReleaseUnused();
  EXPECT_EQ(blocks.idle_bytes(), 2 * kMiB);
  blocks.ReleaseUnused();
  EXPECT_EQ(blocks.idle_bytes(), 0);
}

TEST(LargeBlocks, AreWhatLargeUninitializedVectorsUse) {
  size_t before = 0;
  const void* first = nullptr;
  {
    const UninitializedVector<int> vector(2 * kMiB);
    before = ProcessLargeBlocks().idle_bytes();
    first = vector.data();
  }
  EXPECT_EQ(ProcessLargeBlocks().idle_bytes(), before + 8 * kMiB);
  const UninitializedVector<int> vector(2 * kMiB);
  EXPECT_EQ(vector.data(), first);
}

}  // namespace
}  // namespace bccskel::exec
