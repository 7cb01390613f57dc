// Images whose axes have different units: lengths come in one of them.
#include "core/import/image/axis_units.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/core/import/image/image_bytes.h"
#include "tests/core/import/image/image_folder.h"
#include "tests/core/import/image/tiff_bytes.h"

namespace bccskel::axis_units {
namespace {

using testing::Counting;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::ImageFolder;
using testing::ReadBytes;
using testing::TiffBytes;

TEST(CommonUnit, IsTheSmallestOne) {
  const auto unit = CommonUnitOf({"um", "nanometer", "\xc3\x85"});
  ASSERT_TRUE(unit.ok()) << unit.status();
  EXPECT_EQ(unit->unit, "angstrom");
  EXPECT_THAT(unit->factors, ElementsAre(10000, 10, 1));
  const auto two = CommonUnitOf({std::nullopt, "m", "mm"});
  ASSERT_TRUE(two.ok()) << two.status();
  EXPECT_EQ(two->unit, "mm");
  EXPECT_THAT(two->factors, ElementsAre(1, 1000, 1));
}

TEST(CommonUnit, MayBeAnyThatAllAxesHave) {
  for (const char* name : {"", "pixel", "mm", "micron"}) {
    const auto unit = CommonUnitOf({name, std::nullopt, name});
    ASSERT_TRUE(unit.ok()) << unit.status();
    EXPECT_EQ(unit->unit, std::string(name) == "micron" ? "um" : name);
    EXPECT_THAT(unit->factors, ElementsAre(1, 1, 1));
  }
  EXPECT_EQ(CommonUnitOf({std::nullopt, std::nullopt, std::nullopt})->unit, "");
}

TEST(CommonUnit, IsRefusedWithARemedyWhereOneIsUnknown) {
  const auto message = [](const char* x, const char* z) {
    const auto unit = CommonUnitOf({x, x, z});
    EXPECT_EQ(unit.status().code(), absl::StatusCode::kUnimplemented);
    EXPECT_THAT(std::string(unit.status().message()), HasSubstr("with one unit for all axes"));
    return std::string(unit.status().message());
  };
  EXPECT_THAT(message("pixel", "micron"),
              HasSubstr("('pixel' along x, 'pixel' along y, 'um' along z)"));
  EXPECT_THAT(message("nm", ""), HasSubstr("no unit along z"));
  EXPECT_THAT(message("nm", "s"), HasSubstr("'s' along z"));
}

std::string Nrrd(const std::string& sizes, const std::string& fields) {
  return "NRRD0005\ntype: uint8\nsizes: " + sizes + "\nencoding: raw\n" + fields + "\n\n" +
         Counting<uint8_t>(12);
}

TEST(AxisUnits, OfNrrdBelongToItsAxes) {
  const auto image = MustRead(
      ReadBytes(Nrrd("3 2 2", "dimension: 3\nspacings: 200 200 0.5\nunits: \"nm\" \"nm\" \"um\"")));
  EXPECT_EQ(image.info.unit, "nm");
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(200, 200, 500));
  const auto component = MustRead(ReadBytes(
      Nrrd("1 3 2 2", "dimension: 4\nspacings: nan 1 1 0.5\nunits: \"\" \"mm\" \"mm\" \"cm\"")));
  EXPECT_EQ(component.info.unit, "mm");
  EXPECT_THAT(component.info.placement.spacing, ElementsAre(1, 1, 5));
  const auto slice = MustRead(
      ReadBytes(Nrrd("3 4 1", "dimension: 3\nspacings: 1 1 nan\nunits: \"mm\" \"mm\" \"\"")));
  EXPECT_EQ(slice.info.unit, "mm");
  const auto series = MustRead(ReadBytes(
      Nrrd("3 2 2 1", "dimension: 4\nspacings: 1 1 1 1\nunits: \"mm\" \"mm\" \"mm\" \"s\"")));
  EXPECT_EQ(series.info.unit, "mm");
}

TEST(AxisUnits, OfNrrdsSpaceBelongToCoordinates) {
  const std::string fields =
      "dimension: 3\nspace: RAS\nspace directions: (0,0,1) (0,200,0) (300,0,0)\n"
      "space origin: (10,20,3)\n";
  const auto image =
      MustRead(ReadBytes(Nrrd("3 2 2", fields + "space units: \"nm\" \"nm\" \"um\"")));
  EXPECT_EQ(image.info.unit, "nm");
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(1000, 200, 300));
  EXPECT_THAT(image.info.placement.ToWorld(2, 2, 2), ElementsAre(310, 220, 4000));
  const auto axes = ReadBytes(Nrrd("3 2 2", fields + "units: \"nm\" \"nm\" \"um\""));
  EXPECT_THAT(std::string(axes.status().message()), HasSubstr("state 'space units'"));
  const auto unknown = ReadBytes(Nrrd("3 2 2", fields + "space units: \"nm\" \"nm\" \"s\""));
  EXPECT_THAT(std::string(unknown.status().message()), HasSubstr("with one unit for all axes"));
}

TEST(AxisUnits, OfOmeTiffAreConverted) {
  const std::string sizes =
      "<OME><Image><Pixels DimensionOrder=\"XYZCT\" SizeZ=\"2\" PhysicalSizeX=\"200\" "
      "PhysicalSizeXUnit=\"nm\" PhysicalSizeY=\"0.25\" PhysicalSizeZ=\"1.5\" PhysicalSizeZUnit=\"";
  const auto read = [&](const std::string& unit) {
    const std::string description = sizes + unit + "\"/></Image></OME>";
    return ReadBytes(TiffBytes({.description = description.c_str()}));
  };
  const auto image = read("mm");
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->info.unit, "nm");
  EXPECT_THAT(image->info.placement.spacing, ElementsAre(200, 250, 1500000));
  EXPECT_THAT(std::string(read("pixel").status().message()), HasSubstr("'pixel' along z"));
}

TEST(AxisUnits, OfOmeZarrAreConverted) {
  const ImageFolder folder("units.ome.zarr");
  folder.Write("0/.zarray", R"({"zarr_format":2,"shape":[2,3,4],"chunks":[2,3,4],"dtype":"|u1",)"
                            R"("compressor":null,"fill_value":0,"order":"C","filters":null})");
  const auto read = [&](const std::string& unit) {
    folder.Write(".zattrs",
                 R"({"multiscales":[{"version":"0.4","axes":[{"name":"z","unit":")" + unit +
                     R"("},{"name":"y","unit":"micrometer"},{"name":"x","unit":"nanometer"}],)"
                     R"("datasets":[{"path":"0","coordinateTransformations":[)"
                     R"({"type":"scale","scale":[1,0.2,200]},)"
                     R"({"type":"translation","translation":[3,2,1]}]}]}]})");
    return folder.Read();
  };
  const auto image = read("millimeter");
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->info.unit, "nm");
  EXPECT_THAT(image->info.placement.spacing, ElementsAre(200, 200, 1000000));
  EXPECT_THAT(image->info.placement.origin, ElementsAre(1, 2000, 3000000));
  EXPECT_THAT(std::string(read("").status().message()), HasSubstr("no unit along z"));
}

}  // namespace
}  // namespace bccskel::axis_units
