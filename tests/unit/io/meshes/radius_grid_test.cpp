#include "io/meshes/radius_grid.h"

#include <gmock/gmock.h>

#include <cmath>

#include "io/meshes/mesh_file.h"
#include "io/meshes/shape_table.h"
#include "render/vocabulary/plain_number.h"
#include "render/vocabulary/units.h"
#include "tests/support/files.h"

namespace hilcam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

double volume_of_grid(const Mesh& m) {
    double six = 0;
    for (const auto& t : m.triangles)
        six += dot(to_double(m.vertices_m[t[0]]),
                   cross(to_double(m.vertices_m[t[1]]), to_double(m.vertices_m[t[2]])));
    return six / 6;
}

struct GridShape {
    double step_deg = 10, first_latitude_deg = -90, last_latitude_deg = 90, first_longitude_deg = 0,
           last_longitude_deg = 360;
    bool longitude_first = false;
    std::string behind = {};
};
// A unit sphere with a hill of 10 % at latitude 0, longitude 90.
std::string table_of_radii(const GridShape& g) {
    std::string out;
    for (double latitude = g.first_latitude_deg; latitude <= g.last_latitude_deg; latitude += g.step_deg)
        for (double longitude = g.first_longitude_deg; longitude <= g.last_longitude_deg;
             longitude += g.step_deg) {
            const double radius = latitude == 0 && longitude == 90 ? 1.1 : 1;
            out += g.longitude_first ? plain(longitude) + " " + plain(latitude)
                                     : plain(latitude) + "  " + plain(longitude);
            out += " " + plain(radius) + g.behind + "\r\n";
        }
    return out;
}

// A sphere of 10 degrees a facet holds 4/3 pi less some 2 % (1 - (5 deg)^2 for each of two ways).
TEST(RadiusGrid, ASphereIsOneClosedShell) {
    for (const GridShape& grid :
         {GridShape{}, GridShape{.longitude_first = true}, GridShape{.last_longitude_deg = 350},
          GridShape{.first_longitude_deg = -180, .last_longitude_deg = 180}, GridShape{.behind = " 2.5 7 9"},
          GridShape{.first_latitude_deg = -85,
          .last_latitude_deg = 85,
          .first_longitude_deg = 5,
          .last_longitude_deg = 355}}) {
        std::vector<std::string> remarks;
        const Mesh m = read_shape_table(table_of_radii(grid), "t.tab", Longitudes::kUnsaid, &remarks);
        const bool has_poles = grid.first_latitude_deg == -90;
        const std::size_t rings = has_poles ? 17 : 18;
        EXPECT_EQ(m.vertices_m.size(), 36 * rings + 2);
        EXPECT_EQ(m.triangles.size(), 2 * 36 * rings);
        EXPECT_NEAR(volume_of_grid(m), 4 * kPi / 3 * 0.98, 0.04);
        EXPECT_EQ(m.surfaces.front().name, "shape");
        EXPECT_THAT(remarks, ElementsAre(HasSubstr("its longitudes are taken as east")));
    }
}

TEST(RadiusGrid, LongitudesGoWhereTheyAreSaidTo) {
    const auto hill = [](Longitudes known) {
        std::vector<std::string> remarks;
        const Mesh m = read_shape_table(table_of_radii({}), "t.tab", known, &remarks);
        EXPECT_EQ(remarks.empty(), known != Longitudes::kUnsaid);
        EXPECT_GT(volume_of_grid(m), 4);  // outwards, mirrored or not
        for (const Vec3f& v : m.vertices_m)
            if (std::abs(length(to_double(v)) - 1.1) < 1e-6) return to_double(v);
        return Vec3d{};
    };
    EXPECT_NEAR(hill(Longitudes::kUnsaid).y, 1.1, 1e-6);
    EXPECT_NEAR(hill(Longitudes::kEast).y, 1.1, 1e-6);
    EXPECT_NEAR(hill(Longitudes::kWest).y, -1.1, 1e-6);
}

// In the words of labels in PDS.
TEST(RadiusGrid, LabelsSayWhere) {
    EXPECT_EQ(longitudes_of_label("  POSITIVE_LONGITUDE_DIRECTION   = \"WEST\"\r\n"), Longitudes::kWest);
    EXPECT_EQ(longitudes_of_label("POSITIVE_LONGITUDE_DIRECTION = EAST\n /* not west longitude */"),
              Longitudes::kEast);
    EXPECT_EQ(
        longitudes_of_label("a grid with points every two degrees in latitude and west\n   longitude, and"),
        Longitudes::kWest);
    EXPECT_EQ(longitudes_of_label("Coordinates are planetocentric, increasing to the west."),
              Longitudes::kWest);
    EXPECT_EQ(longitudes_of_label("NAME = \"EAST_LONGITUDE\""), Longitudes::kEast);
    EXPECT_EQ(longitudes_of_label("NAME = LONGITUDE\nUNIT = DEGREE"), Longitudes::kUnsaid);
    EXPECT_EQ(longitudes_of_label("west longitude, or east longitude"), Longitudes::kUnsaid);
    EXPECT_EQ(longitudes_of_label(""), Longitudes::kUnsaid);
}

TEST(RadiusGrid, WhatIsNoWholeBodyIsRefused) {
    const auto why = [](const std::string& text) {
        try {
            read_shape_table(text, "t.tab");
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    EXPECT_THAT(why(table_of_radii({.last_latitude_deg = 10})),
                HasSubstr("t.tab: has no radius from latitude 10 to 90"));
    EXPECT_THAT(why(table_of_radii({.last_longitude_deg = 200})),
                HasSubstr("has no radius for 160 degrees of longitude"));
    EXPECT_THAT(why(table_of_radii({.last_longitude_deg = 80})), HasSubstr("first two do not go beyond 90"));
    EXPECT_THAT(why("100 200 1\n"), HasSubstr("first two both go beyond 90"));
    std::string lacking = table_of_radii({});
    lacking.erase(lacking.find("0  90 1.1"), 11);
    EXPECT_THAT(why(lacking), HasSubstr("has no radius at latitude 0, longitude 90"));
    EXPECT_THAT(why("0 100 1\n91 100 1\n"), HasSubstr("first two both"));
    EXPECT_THAT(why("0 100 1\n0 400 1\n"),
                HasSubstr("t.tab:2: found the longitude 400; accepted: -360 to 360"));
    EXPECT_THAT(why("0 100 1\n0 200 0\n"), HasSubstr("t.tab:2: found the radius 0; accepted: above 0"));
    EXPECT_THAT(why("0 100 1\n0 200\n"),
                HasSubstr("t.tab:2: found '0 200'; accepted: a latitude, a longitude and a radius"));
    EXPECT_THAT(why("0 100 1\n0 200 x\n"), HasSubstr("t.tab:2: found 'x'; accepted: a number"));
}

class RadiusFiles : public FilesTest {};

TEST_F(RadiusFiles, ALabelBesideTheTableIsRead) {
    const auto file = write("s.tab", table_of_radii({.step_deg = 30}));
    const MeshContents unsaid = load_mesh_contents(file);
    EXPECT_THAT(unsaid.remarks, ElementsAre(HasSubstr("its longitudes are taken as east")));
    write("s.LBL", "POSITIVE_LONGITUDE_DIRECTION = WEST\n");
    const MeshContents labelled = load_mesh_contents(file);
    EXPECT_THAT(labelled.remarks, IsEmpty());
    ASSERT_EQ(labelled.mesh.vertices_m.size(), unsaid.mesh.vertices_m.size());
    for (std::size_t i = 0; i < labelled.mesh.vertices_m.size(); ++i)
        EXPECT_EQ(labelled.mesh.vertices_m[i].y, -unsaid.mesh.vertices_m[i].y);
}

}  // namespace
}  // namespace hilcam
