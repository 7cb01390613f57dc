#include "server/calls/request_sequence.h"

#include <gtest/gtest.h>

#include "tests/server/support/declared_volume.h"

// The faults that a stream can have are in skeletonize_fault_test.cc; here is what needs the exact
// moment.

namespace bccskel::server {
namespace {

using test::ChunkRequest, test::ConfigRequest, test::FinishRequest;

RequestSequence Finished() {
  RequestSequence sequence;
  for (const auto& request : RequestsFor(test::SmallTorusPlanes())) {
    EXPECT_TRUE(sequence.Take(request).ok());
  }
  return sequence;
}

TEST(RequestSequence, IsFinishedByFinishAlone) {
  RequestSequence sequence;
  for (const auto& request : RequestsFor(test::SmallTorusPlanes())) {
    EXPECT_FALSE(sequence.finished());
    EXPECT_EQ(sequence.HalfClose().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_TRUE(sequence.Take(request).ok());
  }
  EXPECT_TRUE(sequence.finished());
  EXPECT_TRUE(sequence.HalfClose().ok());
}

TEST(RequestSequence, TakesNothingAfterFinish) {
  for (const auto& request : {ConfigRequest(test::SmallTorusPlanes()), ChunkRequest(0, "x"),
                              FinishRequest(test::SmallTorusPlanes()), v1::SkeletonizeRequest()}) {
    EXPECT_EQ(Finished().Take(request).code(), absl::StatusCode::kInvalidArgument);
  }
}

TEST(RequestSequence, TakesChunksOfAnySizeUpToTheLimit) {
  test::DeclaredVolume volume = test::SmallTorusPlanes();
  volume.declaration.set_size_bytes(kMaxChunkBytes + 1);
  RequestSequence sequence;
  ASSERT_TRUE(sequence.Take(ConfigRequest(volume)).ok());
  EXPECT_TRUE(sequence.Take(ChunkRequest(0, "")).ok());
  EXPECT_TRUE(sequence.Take(ChunkRequest(0, std::string(kMaxChunkBytes, 'x'))).ok());
  EXPECT_TRUE(sequence.Take(ChunkRequest(kMaxChunkBytes, "x")).ok());
  EXPECT_FALSE(sequence.Take(ChunkRequest(kMaxChunkBytes + 1, "x")).ok());
}

}  // namespace
}  // namespace bccskel::server
