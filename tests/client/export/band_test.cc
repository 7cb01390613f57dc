#include "client/export/picture/band.h"

#include <gtest/gtest.h>

namespace bccskel::exporting {
namespace {

// Two triangles over each other, the larger one behind, and a bead between them.
Geometry Layers() {
  Geometry geometry;
  geometry.glass.vertices = {{0, 0, 0},  {20, 0, 0}, {0, -20, 0},
                             {0, 0, 10}, {8, 0, 10}, {0, -8, 10}};
  geometry.glass.triangles = {{0, 1, 2}, {3, 4, 5}};
  geometry.normals.assign(6, {0, 0, 1});
  geometry.beads = {{{4, 15, 5, 3, {1, 0, 0}}}};
  return geometry;
}

void Draw(const Geometry& geometry, Band& band) {
  band.DrawGlass(geometry, std::array<uint32_t, 2>{0, 1});
  band.DrawBeads(geometry.beads[0], std::array<uint32_t, 1>{0});
  band.DrawSheets(geometry.sheets);
}

TEST(BandTest, KeepsTheNearestAndTheFarthestGlass) {
  Band band(20, 0, 20);
  Draw(Layers(), band);
  EXPECT_FLOAT_EQ(band.near_glass(2, 2).depth, 10);
  EXPECT_FLOAT_EQ(band.far_glass(2, 2).depth, 0);
  EXPECT_FLOAT_EQ(band.near_glass(10, 2).depth, 0);
  EXPECT_EQ(band.near_glass(19, 19).depth, -kNothing);
  EXPECT_FLOAT_EQ(band.near_glass(2, 2).normal[2], 1);
}

TEST(BandTest, BeadsAreRound) {
  Band band(20, 0, 20);
  Draw(Layers(), band);
  EXPECT_FLOAT_EQ(band.bead(4, 15).depth, 8);
  EXPECT_FLOAT_EQ(band.bead(4, 12).normal[1], 1);  // its top
  EXPECT_FLOAT_EQ(band.bead(7, 15).normal[0], 1);
  EXPECT_EQ(band.bead(8, 15).depth, -kNothing);
  EXPECT_EQ(band.bead(7, 12).depth, -kNothing);
}

TEST(BandTest, SheetsHideWhatIsBehindThem) {
  Geometry geometry = Layers();
  geometry.sheets.mesh = {{{0, 0, 7}, {20, 0, 7}, {0, -20, 7}}, {{0, 1, 2}}};
  geometry.sheets.normals.assign(3, {0, 1, 0});
  geometry.sheets.colors.assign(3, {0, 0, 1});
  Band band(20, 0, 20);
  Draw(geometry, band);
  EXPECT_FLOAT_EQ(band.bead(2, 2).depth, 7);
  EXPECT_FLOAT_EQ(band.bead(2, 2).normal[1], 1);
  EXPECT_EQ(band.bead(2, 2).color, (LinearColor{0, 0, 1}));
  EXPECT_FLOAT_EQ(band.bead(4, 15).depth, 8);  // the bead is nearer
  EXPECT_EQ(band.bead(4, 15).color, (LinearColor{1, 0, 0}));
  EXPECT_FLOAT_EQ(band.far_glass(10, 2).depth, 0);
}

TEST(BandTest, BandsShowTheirPartOfTheWhole) {
  Band whole(20, 0, 20), lower(20, 12, 8);
  Draw(Layers(), whole);
  Draw(Layers(), lower);
  for (int row = 0; row < 8; ++row) {
    for (int x = 0; x < 20; ++x) {
      EXPECT_EQ(lower.near_glass(x, row).depth, whole.near_glass(x, row + 12).depth);
      EXPECT_EQ(lower.bead(x, row).depth, whole.bead(x, row + 12).depth);
    }
  }
}

}  // namespace
}  // namespace bccskel::exporting
