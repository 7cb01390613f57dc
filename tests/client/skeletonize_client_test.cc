#include "client/skeletonize_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <span>

#include "core/import/shapes/shapes.h"
#include "core/io/volume_decoder.h"

namespace bccskel::client {
namespace {

using testing::_;

class MockConnection : public Connection {
 public:
  MOCK_METHOD(absl::StatusOr<SkeletonizeResult>, Skeletonize,
              (const EncodedVolume& volume, const CallOptions& options), (override));
  MOCK_METHOD(absl::StatusOr<LabelsReport>, SkeletonizeLabels,
              (const EncodedLabels& volume, const LabelsCallOptions& options,
               const LabelConsumer& consume),
              (override));
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

// 3 x 2 x 2 voxels of 16 bits.
constexpr std::array<uint16_t, 12> kLabels = {7, 7, 0, 300, 7, 7, 7, 0, 0, 0, 300, 300};

LabelVolume SomeLabels() {
  return {.grid = {.nx = 3, .ny = 2, .nz = 2, .placement = {}},
          .label_bytes = 2,
          .voxels = std::as_bytes(std::span(kLabels))};
}

TEST(EncodedLabelsTest, PromisesWhatIsThere) {
  const auto all = EncodeForSending(SomeLabels(), {}, {});
  ASSERT_TRUE(all.ok()) << all.status();
  EXPECT_EQ(all->voxels, 8u);
  EXPECT_EQ(all->largest_voxels, 5u);
  EXPECT_EQ(all->runs, 5u);
  EXPECT_EQ(all->labels, 2u);
  const auto one = EncodeForSending(SomeLabels(), {300}, {});
  ASSERT_TRUE(one.ok()) << one.status();
  EXPECT_EQ(one->voxels, 3u);
  EXPECT_EQ(one->runs, 2u);
  EXPECT_EQ(one->labels, 1u);
}

TEST(EncodedLabelsTest, RefusesWhatIsNoVolume) {
  LabelVolume odd = SomeLabels(), cut = SomeLabels(), flat = SomeLabels();
  odd.label_bytes = 3;
  cut.voxels = cut.voxels.first(23);
  flat.grid.nz = 0;
  for (const LabelVolume& volume : {odd, cut, flat}) {
    EXPECT_TRUE(absl::IsInvalidArgument(EncodeForSending(volume, {}, {}).status()));
  }
}

}  // namespace
}  // namespace bccskel::client
