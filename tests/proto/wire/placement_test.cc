#include "proto/wire/placement.h"

#include <gtest/gtest.h>

#include <limits>

namespace bccskel::wire {
namespace {

TEST(PlacementRoundTrip, KeepsEveryField) {
  const Placement placement = {
      .spacing = {0.5, 1, 2}, .origin = {-1, 2.25, 1e9}, .direction = {0, 1, 0, -1, 0, 0, 0, 0, 1}};
  const auto back = FromMessage(ToMessage(placement), "placement");
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(*back, placement);
}

TEST(PlacementRoundTrip, KeepsTheExtent) {
  const LatticeExtent extent = {1, kMaxExtentCells, 77};
  const auto back = FromMessage(ToMessage(extent), "extent");
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(*back, extent);
}

TEST(Placement, AnEmptyMessageMeansTheDefault) {
  EXPECT_EQ(FromMessage(v1::Placement(), "placement").value(), Placement());
}

TEST(Placement, RefusesExtentsOutOfRange) {
  for (uint32_t cells : {0u, static_cast<uint32_t>(kMaxExtentCells) + 1, 0xFFFFFFFFu}) {
    v1::LatticeExtent message = ToMessage(LatticeExtent{1, 1, 1});
    message.set_ny(cells);
    const absl::Status status = FromMessage(message, "extent").status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << cells;
    EXPECT_NE(std::string(status.message()).find("extent.ny"), std::string::npos) << status;
  }
}

TEST(Placement, RefusesValuesThatMakeNoSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  v1::Placement wrong_count, not_finite, not_positive;
  wrong_count.add_origin(1);
  for (double value : {0.0, 0.0, nan}) not_finite.add_origin(value);
  for (double value : {1.0, 0.0, 1.0}) not_positive.add_spacing(value);
  for (const v1::Placement& message : {wrong_count, not_finite, not_positive}) {
    EXPECT_EQ(FromMessage(message, "placement").status().code(), absl::StatusCode::kInvalidArgument)
        << message.ShortDebugString();
  }
}

}  // namespace
}  // namespace bccskel::wire
