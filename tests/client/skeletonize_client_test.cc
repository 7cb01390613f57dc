#include "client/skeletonize_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/volume_decoder.h"
#include "core/shapes/shapes.h"

namespace bccskel::client {
namespace {

using testing::_;

class MockConnection : public Connection {
 public:
  MOCK_METHOD(absl::StatusOr<SkeletonizeResult>, Skeletonize,
              (const EncodedVolume& volume, const CallOptions& options), (override));
  MOCK_METHOD(absl::StatusOr<ServerDescription>, Describe, (std::chrono::milliseconds timeout),
              (override));
};

TEST(SkeletonizeClientTest, SendsAVolumeThatDecodesToTheSamePoints) {
  for (const Shape shape : {Shape::kTubes, Shape::kBox}) {
    const Volume object = *GenerateShape(shape, {.points = 20000});
    const auto connection = std::make_shared<MockConnection>();
    EXPECT_CALL(*connection, Skeletonize(_, _))
        .WillOnce([&](const EncodedVolume& sent, const CallOptions& options) {
          EXPECT_EQ(sent.extent, object.extent());
          EXPECT_EQ(sent.bricks, object.brick_count());
          EXPECT_EQ(options.threads, 3);
          const auto decoded = DecodeVolume(sent.encoding, sent.bytes);
          EXPECT_TRUE(decoded.ok() && *decoded == object) << ShapeName(shape);
          return SkeletonizeResult();
        });
    EXPECT_TRUE(SkeletonizeClient(connection).Skeletonize(object, {.threads = 3}).ok());
  }
}

TEST(SkeletonizeClientTest, HandsTheConnectionsErrorOn) {
  const auto connection = std::make_shared<MockConnection>();
  const absl::Status error = absl::ResourceExhaustedError("too large");
  EXPECT_CALL(*connection, Skeletonize(_, _)).WillOnce([&](auto&, auto&) { return error; });
  EXPECT_EQ(SkeletonizeClient(connection)
                .Skeletonize(*GenerateShape(Shape::kBall, {.points = 5000}), {})
                .status(),
            error);
}

TEST(EncodedVolumeTest, SparseObjectsTravelAsBricksAndFullBoxesAsOpenExr) {
  EXPECT_EQ(BestEncodingOf(*GenerateShape(Shape::kTubes, {.points = 200'000})),
            VolumeEncoding::kBricks);
  EXPECT_EQ(BestEncodingOf(*GenerateShape(Shape::kBox, {.points = 200'000})),
            VolumeEncoding::kOpenExr);
}

}  // namespace
}  // namespace bccskel::client
