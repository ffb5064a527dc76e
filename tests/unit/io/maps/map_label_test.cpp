// Labels as archives have them: what they say of latitudes, longitudes, bounds and units.

#include "io/maps/map_label.h"

#include <gtest/gtest.h>

namespace hilcam {
namespace {

const std::string kPds3 = "PDS_VERSION_ID = PDS3\r\n^IMAGE = \"A.IMG\"\r\n";

// The keywords of MOLA's, LOLA's, HRSC's and HiRISE's labels, in their spellings.
TEST(MapLabel, KindsOfLatitudesAreReadInEverySpelling) {
    const auto planetocentric = [](const std::string& text) { return read_map_label(text).planetocentric; };
    EXPECT_EQ(planetocentric(kPds3 + "COORDINATE_SYSTEM_NAME = PLANETOCENTRIC\r\nEND\r\n"), true);
    EXPECT_EQ(planetocentric(kPds3 + "  COORDINATE_SYSTEM_NAME       = \"PLANETOCENTRIC\"\n"), true);
    EXPECT_EQ(planetocentric(kPds3 + "COORDINATE_SYSTEM_NAME='Planetographic'\n"), false);
    EXPECT_EQ(planetocentric(kPds3 + "PROJECTION_LATITUDE_TYPE = PLANETOCENTRIC\n"), true);
    EXPECT_EQ(planetocentric(kPds3 + "COORDINATE_SYSTEM_NAME = \"MEAN EARTH/POLAR AXIS OF DE421\"\n"
                                     "PROJECTION_LATITUDE_TYPE = \"PLANETODETIC\"\n"),
              false);
    EXPECT_EQ(planetocentric(kPds3 + "COORDINATE_SYSTEM_TYPE = \"BODY-FIXED ROTATING\"\n"), std::nullopt);
    // A comment says nothing, nor does a note.
    EXPECT_EQ(
        planetocentric(kPds3 + "/* COORDINATE_SYSTEM_NAME = PLANETOCENTRIC */\nNOTE = \"PLANETOCENTRIC\"\n"),
        std::nullopt);
    EXPECT_EQ(planetocentric("Object = IsisCube\n Group = Mapping\n  LatitudeType = Planetographic\n"),
              false);
    EXPECT_EQ(planetocentric("Object = IsisCube\n Group = Mapping\n  LatitudeType       = Planetocentric\n"),
              true);
    EXPECT_EQ(
        planetocentric("<?xml version=\"1.0\"?>\n<Product_Observational>\n <cart:latitude_type>Planetocentric"
                       "</cart:latitude_type>\n"),
        true);
    EXPECT_EQ(planetocentric("<Product_Observational><latitude_type >planetographic</latitude_type>"), false);
    EXPECT_EQ(read_map_label("").planetocentric, std::nullopt);
    EXPECT_EQ(read_map_label(kPds3 + "COORDINATE_SYSTEM_NAME = PLANETOCENTRIC\n").latitudes_by,
              "COORDINATE_SYSTEM_NAME");
}

TEST(MapLabel, DirectionsOfLongitudesAreReadInEverySpelling) {
    const auto west = [](const std::string& text) { return read_map_label(text).longitudes_west; };
    EXPECT_EQ(west(kPds3 + "POSITIVE_LONGITUDE_DIRECTION = \"WEST\"\r\n"), true);
    EXPECT_EQ(west(kPds3 + "POSITIVE_LONGITUDE_DIRECTION = West\n"), true);
    EXPECT_EQ(west(kPds3 + "POSITIVE_LONGITUDE_DIRECTION = EAST\n"), false);
    EXPECT_EQ(west(kPds3), std::nullopt);
    EXPECT_EQ(west("Object = IsisCube\n LongitudeDirection = PositiveWest\n"), true);
    EXPECT_EQ(
        west("<Product_Observational><cart:longitude_direction>Positive West</cart:longitude_direction>"),
        true);
}

// MOLA's bounds, and those of the same map with longitudes to the west, of PDS3 and of ISIS.
TEST(MapLabel, BoundsAreInDegreesEast) {
    const auto expect = [](const std::string& text, double west_deg, double east_deg) {
        const auto bounds = read_map_label(text).bounds;
        ASSERT_TRUE(bounds) << text;
        EXPECT_EQ(bounds->west_deg, west_deg) << text;
        EXPECT_EQ(bounds->east_deg, east_deg) << text;
        EXPECT_EQ(bounds->south_deg, -30);
        EXPECT_EQ(bounds->north_deg, 60);
    };
    const std::string latitudes = "MAXIMUM_LATITUDE = 60.0 <DEG>\nMINIMUM_LATITUDE = -30.0<DEG>\n";
    expect(kPds3 + latitudes + "WESTERNMOST_LONGITUDE = 0.0 <DEG>\nEASTERNMOST_LONGITUDE = 360.0 <DEG>\n", 0,
           360);
    expect(kPds3 + latitudes + "WESTERNMOST_LONGITUDE = 350\nEASTERNMOST_LONGITUDE = 20\n", 350, 380);
    expect(kPds3 + latitudes +
               "POSITIVE_LONGITUDE_DIRECTION = WEST\n"
               "WESTERNMOST_LONGITUDE = 270.0\nEASTERNMOST_LONGITUDE = -90.0\n",
           90, 450);
    expect(
        "Object = IsisCube\nLongitudeDirection = PositiveWest\nMinimumLatitude = -30\nMaximumLatitude = "
        "60\nMinimumLongitude = 10\nMaximumLongitude = 40\n",
        -40, -10);
    // What is no number, and what is no area, is no bound.
    EXPECT_FALSE(
        read_map_label(kPds3 + latitudes + "WESTERNMOST_LONGITUDE = \"N/A\"\nEASTERNMOST_LONGITUDE = 1\n")
            .bounds);
    EXPECT_FALSE(
        read_map_label(kPds3 + latitudes + "WESTERNMOST_LONGITUDE = 1e300\nEASTERNMOST_LONGITUDE = 1\n")
            .bounds);
}

// The unit is that of the picture's values, and of nothing else in the label.
TEST(MapLabel, UnitsAreThoseOfTheValues) {
    const auto unit = [](const std::string& text) { return read_map_label(text).unit; };
    EXPECT_EQ(unit(kPds3 + "OBJECT = IMAGE\n UNIT = KILOMETER\nEND_OBJECT = IMAGE\n"), "KILOMETER");
    EXPECT_EQ(unit(kPds3 + "OBJECT = TABLE\n UNIT = DEGREE\nEND_OBJECT\nOBJECT = IMAGE\n UNIT = \"METER\"\n"),
              "METER");
    EXPECT_EQ(unit(kPds3 + "OBJECT = IMAGE_MAP_PROJECTION\n UNIT = DEGREE\nEND_OBJECT\n"), "");
    EXPECT_EQ(unit("<Product_Observational><value unit=\"km\"/><unit>deg</unit><Element_Array>\n "
                   "<data_type>IEEE754LSBSingle"
                   "</data_type><unit>km</unit></Element_Array>"),
              "km");
    EXPECT_EQ(metres_of_unit("KILOMETERS"), 1000);
    EXPECT_EQ(metres_of_unit("metre"), 1);
    EXPECT_EQ(metres_of_unit("m"), 1);
    EXPECT_NEAR(metres_of_unit("US survey foot").value_or(0), 0.3048006096, 1e-10);
    EXPECT_EQ(metres_of_unit("DN"), std::nullopt);
    EXPECT_EQ(metres_of_unit(""), std::nullopt);
}

}  // namespace
}  // namespace hilcam
