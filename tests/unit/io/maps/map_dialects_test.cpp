// Maps whose labels have other latitudes, longitudes, offsets and units than GDAL hands on: the ground is where it is in truth.

#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "io/maps/ground_map_file.h"
#include "render/ground/ground_surface.h"
#include "tests/support/files.h"
#include "tests/support/ground_maps.h"

namespace hilcam {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Archinal et al. 2018.
const MappedBody kMars{"mars", {3396.19e3, 3376.20e3}};
const MappedBody kMoonHere{"moon", {kMoonRadius_m, kMoonRadius_m}};

// A map in 16-bit numbers, most significant byte first, with the label of an archive.
struct Archived {
    double radius_km = 1737.4, polar_radius_km = 1737.4;
    std::string system = "PLANETOCENTRIC", direction = "EAST", unit = "METER";
    double posts_per_deg = 0.2, west_deg = 0, north_deg = 90;  // bounds, in the label's own direction
    double center_deg = 180;
    int columns = 72, rows = 36;
    double offset_off = 0;  // posts by which the projection's offsets are wrong
    double label_offset = 0;
    std::function<int(int, int)> value = [](int, int) { return 0; };
};

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.10g", value);
    return text;
}

class MapDialects : public FilesTest {
  protected:
    std::string values_of(const Archived& m) {
        std::string out;
        for (int r = 0; r < m.rows; ++r)
            for (int c = 0; c < m.columns; ++c) {
                const int v = m.value(c, r);
                out += {static_cast<char>(v >> 8 & 0xFF), static_cast<char>(v & 0xFF)};
            }
        return out;
    }
    // Lines and samples of the projection's origin, as the standard has them: (centre - edge) * resolution - 1/2.
    std::filesystem::path pds3(const std::string& name, const Archived& m) {
        write(name + ".img", values_of(m));
        const double turns = m.direction == "WEST" ? -1 : 1, res = m.posts_per_deg;
        const double east_deg = m.west_deg + turns * m.columns / res;
        std::string text =
            "PDS_VERSION_ID = PDS3\nRECORD_TYPE = FIXED_LENGTH\nRECORD_BYTES = " +
            std::to_string(2 * m.columns) + "\nFILE_RECORDS = " + std::to_string(m.rows) + "\n^IMAGE = \"" +
            name + ".img\"\nTARGET_NAME = MARS\nOBJECT = IMAGE\n LINES = " + std::to_string(m.rows) +
            "\n LINE_SAMPLES = " + std::to_string(m.columns) +
            "\n SAMPLE_TYPE = MSB_INTEGER\n SAMPLE_BITS = 16\n UNIT = " + m.unit +
            "\n SCALING_FACTOR = 1\n OFFSET = " + number(m.label_offset) +
            "\nEND_OBJECT = IMAGE\nOBJECT = IMAGE_MAP_PROJECTION\n MAP_PROJECTION_TYPE = \"SIMPLE "
            "CYLINDRICAL\"\n A_AXIS_RADIUS = " +
            number(m.radius_km) + " <KM>\n B_AXIS_RADIUS = " + number(m.radius_km) +
            " <KM>\n C_AXIS_RADIUS = " + number(m.polar_radius_km) + " <KM>\n";
        if (!m.system.empty()) text += " COORDINATE_SYSTEM_NAME = " + m.system + "\n";
        text += " POSITIVE_LONGITUDE_DIRECTION = \"" + m.direction +
                "\"\n CENTER_LATITUDE = 0.0\n CENTER_LONGITUDE = " + number(m.center_deg) +
                " <DEG>\n MAP_PROJECTION_ROTATION = 0.0\n MAP_RESOLUTION = " + number(res) +
                " <PIX/DEG>\n MAP_SCALE = " + number(2 * kPi * m.radius_km / 360 / res) +
                " <KM/PIX>\n MAXIMUM_LATITUDE = " + number(m.north_deg) +
                "\n MINIMUM_LATITUDE = " + number(m.north_deg - m.rows / res) +
                "\n WESTERNMOST_LONGITUDE = " + number(m.west_deg) +
                "\n EASTERNMOST_LONGITUDE = " + number(east_deg) +
                "\n LINE_PROJECTION_OFFSET = " + number(m.north_deg * res - 0.5 + m.offset_off) +
                "\n SAMPLE_PROJECTION_OFFSET = " +
                number(turns * (m.center_deg - m.west_deg) * res - 0.5 + m.offset_off) +
                "\nEND_OBJECT = IMAGE_MAP_PROJECTION\nEND\n";
        return write(name + ".lbl", text);
    }
    // PDS4: the dictionary of cartography, in what it has to have.
    std::filesystem::path pds4(const std::string& name, const Archived& m, const std::string& file = "") {
        write(name + ".dat", values_of(m));
        const double metres_deg = m.radius_km * 1e3 * kDegree_rad, turns = m.direction == "WEST" ? -1 : 1;
        const auto tag = [](const std::string& key, const std::string& value) {
            return "<cart:" + key + ">" + value + "</cart:" + key + ">\n";
        };
        const auto axis = [](const std::string& key, int elements, int number) {
            return "<Axis_Array><axis_name>" + key + "</axis_name><elements>" + std::to_string(elements) +
                   "</elements><sequence_number>" + std::to_string(number) +
                   "</sequence_number></Axis_Array>\n";
        };
        const std::string plane =
            tag("Planar",
                tag("Map_Projection",
                    tag("map_projection_name", "Equirectangular") +
                        tag("Equirectangular",
                            tag("latitude_of_projection_origin", "0") + tag("standard_parallel_1", "0") +
                                tag("longitude_of_central_meridian", number(m.center_deg)))) +
                    tag("Planar_Coordinate_Information",
                        tag("planar_coordinate_encoding_method", "Coordinate Pair") +
                            tag("Coordinate_Representation",
                                tag("pixel_resolution_x", number(metres_deg / m.posts_per_deg)) +
                                    tag("pixel_resolution_y", number(metres_deg / m.posts_per_deg)))) +
                    tag("Geo_Transformation",
                        tag("upperleft_corner_x", number(turns * (m.west_deg - m.center_deg) * metres_deg)) +
                            tag("upperleft_corner_y", number(m.north_deg * metres_deg))));
        const std::string model =
            tag("Geodetic_Model",
                tag("latitude_type", m.system) + tag("a_axis_radius", number(1e3 * m.radius_km)) +
                    tag("b_axis_radius", number(1e3 * m.radius_km)) +
                    tag("c_axis_radius", number(1e3 * m.polar_radius_km)) +
                    tag("longitude_direction", m.direction == "WEST" ? "Positive West" : "Positive East"));
        return write(
            name + ".xml",
            "<?xml version=\"1.0\"?>\n<Product_Observational xmlns=\"http://pds.nasa.gov/pds4/pds/v1\" "
            "xmlns:cart=\"http://pds.nasa.gov/pds4/cart/"
            "v1\">\n<Observation_Area><Target_Identification><name>MARS"
            "</name></Target_Identification><Discipline_Area>\n" +
                tag("Cartography", tag("Spatial_Reference_Information",
                                       tag("Horizontal_Coordinate_System_Definition", plane + model))) +
                "</Discipline_Area></Observation_Area>\n<File_Area_Observational><File><file_name>" +
                (file.empty() ? name + ".dat" : file) +
                "</file_name></File><Array_2D_Map><offset "
                "unit=\"byte\">0</offset><axes>2</axes><axis_index_order>Last "
                "Index Fastest</axis_index_order><Element_Array><data_type>SignedMSB2</data_type><unit>" +
                m.unit + "</unit></Element_Array>\n" + axis("Line", m.rows, 1) +
                axis("Sample", m.columns, 2) +
                "</Array_2D_Map></File_Area_Observational>\n</Product_Observational>\n");
    }
    static GroundMapConfig config_of(const std::filesystem::path& file) {
        GroundMapConfig config;
        config.file = file;
        config.blend_posts = 0;
        return config;
    }
    static Vec3d place(double longitude_deg, double latitude_deg) {
        return place_on_sphere(longitude_deg, latitude_deg);
    }
    static double height_m(const GroundMapConfig& config, const MappedBody& body, double longitude_deg,
                           double latitude_deg) {
        std::vector<GroundMap> maps;
        maps.push_back(open_ground_map(config, body));
        GroundSurface surface(body.figure, std::move(maps), std::size_t{1} << 20);
        const Vec3d at = place(longitude_deg, latitude_deg);
        double height_m = 0;
        surface.find_heights({&at, 1}, 0, {&height_m, 1});
        return height_m;
    }
    static GroundRaster::Reading reading_of(const GroundMapConfig& config, const MappedBody& body) {
        return open_ground_map(config, body).raster->reading();
    }
    // The geodetic latitude at which a step of 1000 m is half way up.
    static double step_deg(const GroundMapConfig& config) {
        std::vector<GroundMap> maps;
        maps.push_back(open_ground_map(config, kMars));
        GroundSurface surface(kMars.figure, std::move(maps), std::size_t{1} << 20);
        double low = 41, high = 44;
        for (int i = 0; i < 30; ++i) {
            const double middle = 0.5 * (low + high);
            const Vec3d at = place(2.5, middle);
            double height_m = 0;
            surface.find_heights({&at, 1}, 0, {&height_m, 1});
            (height_m < 500 ? low : high) = middle;
        }
        return low;
    }
    // A step of Mars' ground at latitude 42.5, posts of a twentieth of a degree.
    static Archived step(double polar_radius_km, const std::string& system) {
        Archived out{3396.19, polar_radius_km, system};
        out.posts_per_deg = 20, out.north_deg = 45, out.center_deg = 0, out.columns = out.rows = 100;
        out.value = [](int, int r) { return 45 - 0.025 - 0.05 * r > 42.5 ? 1000 : 0; };
        return out;
    }
    // The Moon with a hill in columns to the east of `west_deg`, 92.5 E and 22.5 N.
    static Archived hill(double west_deg) {
        Archived out;
        out.west_deg = west_deg;
        out.value = [west_deg](int c, int r) {
            const double east = std::fmod(west_deg + 2.5 + 5 * c + 720, 360);
            return std::abs(east - 92.5) < 1 && r == 13 ? 4000 : 0;
        };
        return out;
    }
};

// tan(planetographic) = tan(planetocentric) (a/b)^2: 42.5 deg of the line from the middle is 42.837 deg of the normal.
TEST_F(MapDialects, PlanetocentricLatitudesOfAFlattenedBodyArePlaced) {
    EXPECT_NEAR(step_deg(config_of(pds3("sphere", step(3396.19, "PLANETOCENTRIC")))), 42.837, 0.002);
    EXPECT_NEAR(step_deg(config_of(pds3("ellipsoid", step(3376.20, "PLANETOCENTRIC")))), 42.837, 0.002);
    EXPECT_NEAR(step_deg(config_of(pds3("graphic", step(3376.20, "PLANETOGRAPHIC")))), 42.5, 0.002);
    EXPECT_NEAR(step_deg(config_of(pds3("graphic_sphere", step(3396.19, "PLANETOGRAPHIC")))), 42.5, 0.002);
    // A label that is silent, and the key that speaks for it or against it.
    GroundMapConfig config = config_of(pds3("silent", step(3376.20, "")));
    EXPECT_THAT(reading_of(config, kMars).taken,
                HasSubstr("latitudes planetographic (taken: the file does not say"));
    config.latitudes = MapLatitudes::kPlanetocentric;
    EXPECT_NEAR(step_deg(config), 42.837, 0.002);
    EXPECT_THAT(reading_of(config, kMars).taken, HasSubstr("latitudes planetocentric (latitudes)"));
    // With bounds of the scenario, too, which is what the label says of its latitudes.
    config = config_of(pds3("bounds", step(3376.20, "PLANETOCENTRIC")));
    config.bounds_deg = {0, 40, 5, 45};
    EXPECT_NEAR(step_deg(config), 42.837, 0.002);
    EXPECT_THAT(reading_of(config, kMars).taken,
                HasSubstr("latitudes planetocentric (label: COORDINATE_SYSTEM_NAME)"));
}

TEST_F(MapDialects, Pds4LabelsSayTheSame) {
    Archived map = step(3376.20, "Planetocentric");
    map.unit = "m";
    EXPECT_NEAR(step_deg(config_of(pds4("centric", map))), 42.837, 0.002);
    EXPECT_THAT(reading_of(config_of(folder_ / "centric.xml"), kMars).taken,
                AllOf(HasSubstr("latitudes planetocentric (label: latitude_type)"),
                      HasSubstr("longitudes to the east (label: longitude_direction)")));
    map.system = "Planetographic";
    EXPECT_NEAR(step_deg(config_of(pds4("graphic", map))), 42.5, 0.002);
    // From 0 to 5 E is from 360 to 355 W.
    map.direction = "WEST", map.west_deg = 360, map.center_deg = 357.5;
    EXPECT_NEAR(step_deg(config_of(pds4("west", map))), 42.5, 0.002);
    map.unit = "km";
    map.value = [](int, int) { return 2; };
    EXPECT_NEAR(height_m(config_of(pds4("km", map)), kMars, 2.5, 42), 2000, 1e-3);
    // Its files are of its own folder, as those of other labels.
    for (const char* const elsewhere : {"../west.dat", "/etc/passwd", "sub/west.dat", "&#47;etc&#47;passwd"})
        EXPECT_THAT(error_of([&] { open_ground_map(config_of(pds4("away", map, elsewhere)), kMars); }),
                    HasSubstr("its label points at"))
            << elsewhere;
}

TEST_F(MapDialects, ARoundBodyHasOneKindOfLatitudes) {
    EXPECT_NEAR(height_m(config_of(pds3("round", hill(0))), kMoonHere, 92.5, 22.5), 4000, 1e-3);
    EXPECT_THAT(reading_of(config_of(folder_ / "round.lbl"), kMoonHere).taken,
                "longitudes to the east (label: POSITIVE_LONGITUDE_DIRECTION)");
}

TEST_F(MapDialects, LongitudesToTheWestArePlaced) {
    // The same ground from 90 E on, in both directions: centre 270 E is 90 W.
    Archived east = hill(90);
    east.center_deg = 270;
    Archived west = hill(90);
    west.direction = "WEST", west.west_deg = 270, west.center_deg = 90;
    for (const auto& file : {pds3("east", east), pds3("west", west)}) {
        EXPECT_NEAR(height_m(config_of(file), kMoonHere, 92.5, 22.5), 4000, 1e-3) << file;
        EXPECT_NEAR(height_m(config_of(file), kMoonHere, -87.5, 22.5), 0, 1e-3) << file;
        EXPECT_THAT(reading_of(config_of(file), kMoonHere).doubts, IsEmpty()) << file;
    }
    // An ISIS cube of 8 x 4 numbers, 0, 1, 2, ... by row, centre 90 W: its second column is at 157.5 E.
    const GroundMapConfig cube = config_of(HILCAM_SOURCE_DIR "/tests/fuzz/corpus/ground_map/west.cub");
    EXPECT_NEAR(height_m(cube, kMoonHere, 157.5, 22.5), 9, 1e-3);
    EXPECT_THAT(reading_of(cube, kMoonHere).taken,
                HasSubstr("longitudes to the west (label: LongitudeDirection)"));
    // The key overrides the label.
    GroundMapConfig config = config_of(folder_ / "west.lbl");
    config.longitudes = MapLongitudes::kEast;
    EXPECT_NEAR(height_m(config, kMoonHere, -87.5, 22.5), 4000, 1e-3);
    config = config_of(folder_ / "east.lbl");
    config.longitudes = MapLongitudes::kWest;  // 270 W is 90 E
    EXPECT_NEAR(height_m(config, kMoonHere, -87.5, 22.5), 4000, 1e-3);
    EXPECT_THAT(reading_of(config, kMoonHere).taken, HasSubstr("longitudes to the west (longitudes)"));
}

// A region whose offsets are a post off is doubted, with the bounds to give; a map that thereby reaches beyond a pole is refused.
TEST_F(MapDialects, OffsetsAreHeldAgainstTheLabelsOwnBounds) {
    Archived whole = hill(0);
    whole.offset_off = 1;
    const std::filesystem::path file = pds3("mola", whole);
    EXPECT_THAT(error_of([&] { open_ground_map(config_of(file), kMoonHere); }),
                AllOf(HasSubstr("beyond a pole, at a latitude of 92.5 deg"),
                      HasSubstr("bounds_deg: [0, -90, 360, 90]")));
    GroundMapConfig config = config_of(file);
    config.bounds_deg = {0, -90, 360, 90};
    EXPECT_NEAR(height_m(config, kMoonHere, 92.5, 22.5), 4000, 1e-3);
    EXPECT_THAT(reading_of(config, kMoonHere).doubts, IsEmpty());
    Archived part = step(3396.19, "PLANETOCENTRIC");
    part.offset_off = 1;
    EXPECT_THAT(reading_of(config_of(pds3("part", part)), kMars).doubts,
                ElementsAre(AllOf(HasSubstr("put it 1 post north and 1 post west of the bounds"),
                                  HasSubstr("bounds_deg: [0, 40, 5, 45]"))));
    part.offset_off = 0.5;
    EXPECT_THAT(reading_of(config_of(pds3("half", part)), kMars).doubts,
                ElementsAre(HasSubstr("0.5 posts north and 0.5 posts west")));
    part.offset_off = 0;
    EXPECT_THAT(reading_of(config_of(pds3("right", part)), kMars).doubts, IsEmpty());
}

TEST_F(MapDialects, UnitsAndRadiiOfHeightsAreSeen) {
    Archived map = hill(0);
    map.unit = "KILOMETER";
    map.value = [](int c, int) { return c % 5; };
    EXPECT_NEAR(height_m(config_of(pds3("km", map)), kMoonHere, 7.5, 22.5), 1000, 1e-3);
    EXPECT_THAT(reading_of(config_of(folder_ / "km.lbl"), kMoonHere).taken,
                HasSubstr("heights in KILOMETER (label)"));
    map.unit = "DN";
    EXPECT_THAT(reading_of(config_of(pds3("dn", map)), kMoonHere).doubts,
                testing::Contains(HasSubstr("'DN'")));
    map.unit = "METER";
    map.label_offset = 1737400;
    EXPECT_THAT(error_of([&] { open_ground_map(config_of(pds3("radius", map)), kMoonHere); }),
                AllOf(HasSubstr("are radii, 1737400 to 1737404 m"), HasSubstr("offset: -1737400")));
    GroundMapConfig config = config_of(folder_ / "radius.lbl");
    config.offset = -1737400;
    EXPECT_NEAR(height_m(config, kMoonHere, 7.5, 22.5), 1, 1e-3);
}

// A number that stands for holes without the file saying so is a hole, and no mean has it in it.
TEST_F(MapDialects, NumbersOfHabitAreHoles) {
    Archived map = hill(0);
    map.value = [](int c, int r) { return r == 13 && c == 18 ? -9999 : 100 + c; };
    const std::filesystem::path file = pds3("unsaid", map);
    EXPECT_THAT(error_of([&] { open_ground_map(config_of(file), kMoonHere); }),
                AllOf(HasSubstr("has a hole"), HasSubstr("column 18, row 13")));
    GroundMapConfig config = config_of(file);
    config.holes = MapHoles::kFill;
    EXPECT_EQ(height_m(config, kMoonHere, 92.5, 22.5), 0);
    EXPECT_THAT(reading_of(config, kMoonHere).doubts,
                ElementsAre(HasSubstr("the value -9999 is taken as a hole")));
    const GroundMap open = open_ground_map(config, kMoonHere);
    std::vector<float> values(1);
    open.raster->read(1, 9, 6, 1, 1, values);
    EXPECT_NEAR(values[0], 100 + (19 + 18 + 19) / 3.0, 1e-3);
    // The key says it instead.
    config.no_data = {100};
    EXPECT_NEAR(height_m(config, kMoonHere, 92.5, 22.5), -9999, 1e-3);
    EXPECT_EQ(height_m(config, kMoonHere, 2.5, 27.5), 0);
}

}  // namespace
}  // namespace hilcam
