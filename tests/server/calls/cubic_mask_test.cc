#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>

#include "core/pipeline/algorithm_version.h"
#include "tests/server/support/declared_volume.h"
#include "tests/server/support/raw_call.h"
#include "tests/server/support/running_server.h"

// Callers that hold a cubic mask need not know the lattice.

namespace bccskel {
namespace {

using test::Converse, test::DeclaredVolume, test::SkeletonOf;

constexpr uint32_t kEdge = 9;

// The edges of a cube of 9 x 9 x 9 voxels: 5 loops.
bool IsInFrame(uint32_t x, uint32_t y, uint32_t z) {
  const auto at_side = [](uint32_t v) { return v == 0 || v == kEdge - 1 ? 1 : 0; };
  return at_side(x) + at_side(y) + at_side(z) >= 2;
}

template <typename Inside>
DeclaredVolume MaskOf(Inside inside) {
  DeclaredVolume mask;
  mask.bytes = std::string((kEdge * kEdge * kEdge + 7) / 8, '\0');
  for (uint32_t n = 0; n < kEdge * kEdge * kEdge; ++n) {
    if (!inside(n % kEdge, n / kEdge % kEdge, n / kEdge / kEdge)) continue;
    mask.bytes[n / 8] = static_cast<char>(mask.bytes[n / 8] | 1 << n % 8);
  }
  v1::VolumeDeclaration& declaration = mask.declaration;
  declaration.set_encoding(v1::VOLUME_ENCODING_CUBIC_MASK);
  declaration.mutable_extent()->set_nx(kEdge);
  declaration.mutable_extent()->set_ny(kEdge);
  declaration.mutable_extent()->set_nz(kEdge);
  for (double spacing : {1.0, 2.0, 3.0}) {
    declaration.mutable_placement()->add_spacing(spacing);
  }
  declaration.set_size_bytes(mask.bytes.size());
  return mask;
}

TEST(CubicMask, BecomesASkeletonWithTheMasksTopologyInTheWorldOfItsVoxels) {
  const auto server = test::StartServer();
  const auto replies = Converse(*server, RequestsFor(MaskOf(IsInFrame), 17));
  const auto skeleton = SkeletonOf(replies);
  ASSERT_TRUE(skeleton.ok()) << replies.status << ' ' << skeleton.status();
  const BettiNumbers frame = {1, 5, 0};
  EXPECT_EQ(skeleton->certificate.mask, frame);
  EXPECT_EQ(skeleton->certificate.input, frame);
  EXPECT_EQ(skeleton->certificate.skeleton, frame);
  for (const SkeletonPoint& point : skeleton->graph.points) {
    const WorldPoint world = skeleton->graph.PositionOf(point);
    for (size_t axis : {0U, 1U, 2U}) {  // within the outer faces of the outer voxels
      EXPECT_GE(world[axis], -0.5 * static_cast<double>(axis + 1));
      EXPECT_LE(world[axis], (kEdge - 0.5) * static_cast<double>(axis + 1));
    }
  }
}

// Two voxels that touch at a corner only.
TEST(CubicMask, IsReadInTheAdjacencyAskedFor) {
  const auto server = test::StartServer();
  DeclaredVolume mask = MaskOf(
      [](uint32_t x, uint32_t y, uint32_t z) { return x == y && y == z && (x == 3 || x == 4); });
  for (const auto& [adjacency, components] :
       {std::pair(v1::MASK_ADJACENCY_OBJECT_26, 1), std::pair(v1::MASK_ADJACENCY_OBJECT_6, 2)}) {
    mask.declaration.set_mask_adjacency(adjacency);
    const auto skeleton = SkeletonOf(Converse(*server, RequestsFor(mask)));
    ASSERT_TRUE(skeleton.ok()) << skeleton.status();
    EXPECT_EQ(skeleton->certificate.mask, (BettiNumbers{components, 0, 0}));
    EXPECT_EQ(skeleton->certificate.skeleton, (BettiNumbers{components, 0, 0}));
  }
}

// A rod of three voxels, on lattices of either density.
TEST(CubicMask, HasAsManyPointsAVoxelAsAskedFor) {
  const auto server = test::StartServer();
  DeclaredVolume mask =
      MaskOf([](uint32_t x, uint32_t y, uint32_t z) { return x > 2 && x < 6 && y == 4 && z == 4; });
  for (const auto& [points, count] :
       {std::pair(v1::VOXEL_POINTS_UNSPECIFIED, 3U + 16), std::pair(v1::VOXEL_POINTS_TWO, 3U + 16),
        std::pair(v1::VOXEL_POINTS_SIXTEEN, 24U + 63)}) {
    mask.declaration.set_voxel_points(points);
    const auto skeleton = SkeletonOf(Converse(*server, RequestsFor(mask)));
    ASSERT_TRUE(skeleton.ok()) << skeleton.status();
    EXPECT_EQ(skeleton->object_points, count);
    const bool two = points != v1::VOXEL_POINTS_SIXTEEN;
    EXPECT_EQ(skeleton->options.source, two ? ObjectSource::kVoxels : ObjectSource::kRefinedVoxels);
    EXPECT_EQ(skeleton->algorithm_version, kMaskAlgorithmVersion);
    EXPECT_EQ(skeleton->certificate.skeleton, (BettiNumbers{1, 0, 0}));
  }
}

// Voxels of 1 x 1 x 9 are cut into three slabs, which the bound for blocks of voxels allows for.
TEST(CubicMask, OfThickSlicesMayHaveSlabsTimesTheBricksDeclared) {
  const auto server = test::StartServer();
  DeclaredVolume mask = MaskOf([](uint32_t x, uint32_t y, uint32_t) { return x < 4 && y < 3; });
  mask.declaration.mutable_placement()->mutable_spacing()->Set(2, 9);
  const uint32_t blocks = (mask.declaration.extent().nz() + 8) / 8;  // of 16 x 4 x 8 voxels
  mask.declaration.set_max_bricks(2 * blocks);
  const auto skeleton = SkeletonOf(Converse(*server, RequestsFor(mask)));
  ASSERT_TRUE(skeleton.ok()) << skeleton.status();
  EXPECT_EQ(skeleton->options.voxel_slabs, (std::array<int32_t, 3>{1, 1, 3}));
  EXPECT_EQ(skeleton->certificate.skeleton, (BettiNumbers{1, 0, 0}));
}

struct Fault {
  const char* what;
  void (*damage)(DeclaredVolume&);
};

TEST(CubicMask, IsRefusedWhereItIsNotWhatItDeclares) {
  const auto server = test::StartServer();
  const Fault faults[] = {
      {"adjacency",
       [](DeclaredVolume& m) {
         m.declaration.set_mask_adjacency(static_cast<v1::MaskAdjacency>(9));
       }},
      {"points a voxel",
       [](DeclaredVolume& m) { m.declaration.set_voxel_points(static_cast<v1::VoxelPoints>(9)); }},
      {"too few bytes",
       [](DeclaredVolume& m) {
         m.bytes.pop_back();
         m.declaration.set_size_bytes(m.bytes.size());
       }},
      {"too many bytes",
       [](DeclaredVolume& m) {
         m.bytes.push_back('\0');
         m.declaration.set_size_bytes(m.bytes.size());
       }},
      {"bits past the end", [](DeclaredVolume& m) { m.bytes.back() = '\xff'; }},
      {"bricks", [](DeclaredVolume& m) { m.declaration.set_max_bricks(1); }},
      {"voxels", [](DeclaredVolume& m) { m.declaration.mutable_extent()->set_nx(1 << 22); }},
      {"compression",
       [](DeclaredVolume& m) { m.declaration.set_compression(v1::VOLUME_COMPRESSION_ZSTD); }},
  };
  for (const Fault& fault : faults) {
    DeclaredVolume mask = MaskOf(IsInFrame);
    fault.damage(mask);
    const auto replies = Converse(*server, RequestsFor(mask));
    EXPECT_EQ(replies.status.code(), absl::StatusCode::kInvalidArgument)
        << fault.what << ": " << replies.status;
  }
}

}  // namespace
}  // namespace bccskel
