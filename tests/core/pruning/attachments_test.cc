#include "core/pruning/attachments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/certificate/certificate.h"

namespace bccskel {
namespace {

constexpr int32_t kAxis = 40;  // y and z of the body's middle line
constexpr int32_t kLeft = 40, kRight = 200, kStart = 60, kStrand = 52, kOut = 160, kTip = 106;

// The lattice points of a box where it says so.
Volume VolumeWhere(const std::function<bool(LatticePoint)>& inside) {
  std::vector<LatticePoint> points;
  for (int32_t odd : {0, 1}) {
    for (int32_t z = odd; z < 90; z += 2) {
      for (int32_t y = odd; y < 130; y += 2) {
        for (int32_t x = odd; x < 240; x += 2) {
          if (inside({x, y, z})) points.push_back({x, y, z});
        }
      }
    }
  }
  return VolumeOfPoints(points);
}

// A long body, 48 thick, and a limb out of it, 10 thick.
bool InBodyOrLimb(LatticePoint p) {
  const double x = std::clamp(p.x, kLeft, kRight) - p.x, y = p.y - kAxis, z = p.z - kAxis;
  if (x * x + y * y + z * z < 24 * 24) return true;
  return p.y > kAxis && p.y < kTip + 5 && (p.x - kOut) * (p.x - kOut) + z * z < 5 * 5;
}

// The body's middle line, and the limb's, which runs beside it before it turns.
std::vector<LatticePoint> CurvesSideBySide() {
  std::vector<LatticePoint> points;
  for (int32_t x = kLeft; x <= kRight; x += 2) points.push_back({x, kAxis, kAxis});
  for (int32_t y = kAxis + 2; y <= kStrand; y += 2) points.push_back({kStart, y, kAxis});
  for (int32_t x = kStart + 2; x <= kOut; x += 2) points.push_back({x, kStrand, kAxis});
  for (int32_t y = kStrand + 2; y <= kTip; y += 2) points.push_back({kOut, y, kAxis});
  return points;
}

struct Slid {
  Volume before, after;
  std::vector<LatticePoint> ends, junctions;
};

Slid Slide(const Volume& object, const std::vector<LatticePoint>& points,
           const PointSet& keep = {}) {
  Slid slid{VolumeOfPoints(points), {}, {}, {}};
  const ExactRadius radius(object);
  const std::vector<float> radii = *ExactRadii(slid.before, radius, {});
  ThinSet set({.thin = slid.before, .radii = radii});
  PruningLevels levels;
  SlideAttachments(set, object, radius, keep, {}, levels);
  slid.after = set.ToVolume(slid.before);
  slid.ends = set.Ends();
  set.ForEachPoint([&](LatticePoint p) {
    EXPECT_TRUE(object.Contains(p));
    EXPECT_GT(set.RadiusOf(p), 0);
    if (set.Degree(p) > 2) slid.junctions.push_back(p);
  });
  return slid;
}

TEST(SlideAttachments, MovesALimbToWhereItEntersTheBody) {
  const Volume object = VolumeWhere(InBodyOrLimb);
  const Slid slid = Slide(object, CurvesSideBySide());
  EXPECT_LT(slid.after.PointCount() + 40, slid.before.PointCount());
  EXPECT_EQ(*CountBettiNumbers(slid.after, {}), *CountBettiNumbers(slid.before, {}));
  EXPECT_EQ(slid.ends.size(), 3u);
  EXPECT_TRUE(std::ranges::find(slid.ends, LatticePoint{kOut, kTip, kAxis}) != slid.ends.end());
  ASSERT_FALSE(slid.junctions.empty());
  for (LatticePoint p : slid.junctions) EXPECT_GT(p.x, kOut - 40);
}

TEST(SlideAttachments, DoesNotCrossATunnel) {
  const Volume object = VolumeWhere([](LatticePoint p) {
    const int32_t x = p.x - 110, y = p.y - (kAxis + kStrand) / 2;
    return InBodyOrLimb(p) && x * x + y * y > 3 * 3;
  });
  const Slid slid = Slide(object, CurvesSideBySide());
  EXPECT_EQ(*CountBettiNumbers(slid.after, {}), *CountBettiNumbers(slid.before, {}));
  EXPECT_EQ(slid.ends.size(), 3u);
  EXPECT_TRUE(slid.after.Contains({110, kStrand, kAxis}));
}

TEST(SlideAttachments, LeavesKeptPoints) {
  const Volume object = VolumeWhere(InBodyOrLimb);
  const Slid slid = Slide(object, CurvesSideBySide(), {{100, kStrand, kAxis}});
  EXPECT_EQ(slid.after, slid.before);
}

// Where a limb leaves the body at once there is nothing to be gained.
TEST(SlideAttachments, LeavesALimbThatLeavesAtOnce) {
  std::vector<LatticePoint> points;
  for (int32_t x = kLeft; x <= kRight; x += 2) points.push_back({x, kAxis, kAxis});
  for (int32_t y = kAxis + 2; y <= kTip; y += 2) points.push_back({kOut, y, kAxis});
  const Slid slid = Slide(VolumeWhere(InBodyOrLimb), points);
  EXPECT_EQ(slid.after, slid.before);
}

}  // namespace
}  // namespace bccskel
