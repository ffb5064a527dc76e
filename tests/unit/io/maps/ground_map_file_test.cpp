#include "io/maps/ground_map_file.h"

#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>

#include "render/ground/ground_surface.h"
#include "render/vocabulary/check.h"
#include "tests/support/ground_maps.h"

namespace hilcam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const MappedBody kMoonBody{"moon", {kMoonRadius_m, kMoonRadius_m}};

std::filesystem::path file_named(const std::string& name) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("hilcam_maps_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    return folder / name;
}

// A raster of a function of column and row, written by GDAL.
struct MadeMap {
    std::string driver = "GTiff";
    std::string projection;  // PROJ string; empty: none
    std::array<double, 6> to_ground{0, 1, 0, 0, 0, -1};
    int columns = 64, rows = 32;
    std::function<double(int, int)> value = [](int c, int r) { return 100 * std::sin(0.3 * c) + 7.0 * r; };
    double none = std::nan("");
    double scale = 1, offset = 0;
    char** options = nullptr;
};
std::filesystem::path made(const std::string& name, const MadeMap& m) {
    GDALRegister_GTiff();
    GDALRegister_ENVI();
    const std::filesystem::path file = file_named(name);
    GDALDataset* const out = GetGDALDriverManager()
                                 ->GetDriverByName(m.driver.c_str())
                                 ->Create(file.c_str(), m.columns, m.rows, 1, GDT_Float32, m.options);
    if (!m.projection.empty()) {
        OGRSpatialReference reference;
        EXPECT_EQ(reference.importFromProj4(m.projection.c_str()), OGRERR_NONE);
        out->SetSpatialRef(&reference);
        std::array<double, 6> to_ground = m.to_ground;
        out->SetGeoTransform(to_ground.data());
    }
    if (!std::isnan(m.none)) out->GetRasterBand(1)->SetNoDataValue(m.none);
    if (m.scale != 1) out->GetRasterBand(1)->SetScale(m.scale), out->GetRasterBand(1)->SetOffset(m.offset);
    std::vector<float> row(static_cast<std::size_t>(m.columns));
    for (int r = 0; r < m.rows; ++r) {
        for (int c = 0; c < m.columns; ++c)
            row[static_cast<std::size_t>(c)] = static_cast<float>(m.value(c, r));
        EXPECT_EQ(out->GetRasterBand(1)->RasterIO(GF_Write, 0, r, m.columns, 1, row.data(), m.columns, 1,
                                                  GDT_Float32, 0, 0),
                  CE_None);
    }
    GDALClose(out);
    return file;
}

GroundMapConfig config_of(const std::filesystem::path& file) {
    GroundMapConfig config;
    config.file = file;
    config.blend_posts = 0;
    return config;
}

std::string refusal_of(const GroundMapConfig& config) {
    try {
        open_ground_map(config, kMoonBody);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

double height_at(const GroundMapConfig& config, double longitude_deg, double latitude_deg) {
    std::vector<GroundMap> maps;
    maps.push_back(open_ground_map(config, kMoonBody));
    GroundSurface surface(kMoonBody.figure, std::move(maps), std::size_t{1} << 20);
    const Vec3d place = place_on_sphere(longitude_deg, latitude_deg);
    double height_m = 0;
    surface.find_heights({&place, 1}, 0, {&height_m, 1});
    return height_m;
}

constexpr const char* kDegrees = "+proj=longlat +R=1737400 +no_defs";
constexpr double kColumn_deg = 360.0 / 64, kRow_deg = 180.0 / 32;

MadeMap whole_moon() {
    MadeMap map;
    map.projection = kDegrees;
    map.to_ground = {-180, kColumn_deg, 0, 90, 0, -kRow_deg};
    return map;
}

// Between four posts the value is bilinear, over the antimeridian the last column's neighbour is the first, and a pole
// belongs to all meridians.
TEST(GroundMapFile, AWholeBodyInDegreesIsBilinearAndHasNoSeam) {
    const MadeMap map = whole_moon();
    const GroundMapConfig config = config_of(made("degrees.tif", map));
    EXPECT_NEAR(
        height_at(config, -180 + 10.25 * kColumn_deg + kColumn_deg / 2, 90 - 5.5 * kRow_deg - kRow_deg / 2),
        0.5 * (0.75 * map.value(10, 5) + 0.25 * map.value(11, 5) + 0.75 * map.value(10, 6) +
               0.25 * map.value(11, 6)),
        1e-4);
    EXPECT_NEAR(height_at(config, 180, 90 - 5.5 * kRow_deg), 0.5 * (map.value(63, 5) + map.value(0, 5)),
                1e-4);
    EXPECT_NEAR(height_at(config, -180, 90 - 5.5 * kRow_deg), height_at(config, 180, 90 - 5.5 * kRow_deg),
                1e-9);
    double mean_m = 0;
    for (int c = 0; c < 64; ++c) mean_m += map.value(c, 0) / 64;
    for (const double lon : {0.0, 77.0, 180.0}) EXPECT_NEAR(height_at(config, lon, 90), mean_m, 1e-4);
}

// The same ground in other formats and projections has the same heights.
TEST(GroundMapFile, ProjectionsAgreeWithTheirFormulas) {
    const auto ground = [](double lon, double lat) {
        return 1000 * std::sin(lon * kDegree_rad) * std::cos(lat * kDegree_rad);
    };
    // Equirectangular from 0 to 360 E, in metres.
    const double turn_m = 2 * kPi * kMoonRadius_m;
    MadeMap plane;
    plane.projection = "+proj=eqc +R=1737400 +lon_0=180 +units=m +no_defs";
    plane.columns = 720, plane.rows = 360;
    plane.to_ground = {-0.5 * turn_m, turn_m / 720, 0, 0.25 * turn_m, 0, -turn_m / 720};
    plane.value = [&](int c, int r) { return ground(0.5 * (c + 0.5), 90 - 0.5 * (r + 0.5)); };
    // Polar stereographic of the south: rho = 2 R tan((90 - |lat|) / 2), x = rho sin lon, y = rho cos lon (Snyder, USGS
    // Professional Paper 1395, 1987, eqs 21-5 to 21-8 with k0 = 1).
    MadeMap polar;
    polar.projection = "+proj=stere +lat_0=-90 +lon_0=0 +k=1 +R=1737400 +units=m +no_defs";
    polar.columns = polar.rows = 400;
    polar.to_ground = {-200e3, 1000, 0, 200e3, 0, -1000};
    polar.value = [&](int c, int r) {
        const double x = -200e3 + 1000 * (c + 0.5), y = 200e3 - 1000 * (r + 0.5);
        return ground(std::atan2(x, y) / kDegree_rad,
                      -90 + 2 * std::atan(std::hypot(x, y) / (2 * kMoonRadius_m)) / kDegree_rad);
    };
    MadeMap envi = plane;
    envi.driver = "ENVI";
    for (const double lon : {-179.9, -90.0, 0.1, 33.3, 179.95})
        for (const double lat : {-89.0, -85.5}) {
            EXPECT_NEAR(height_at(config_of(made("eqc.tif", plane)), lon, lat), ground(lon, lat), 0.05);
            EXPECT_NEAR(height_at(config_of(made("eqc.img", envi)), lon, lat), ground(lon, lat), 0.05);
            EXPECT_NEAR(height_at(config_of(made("polar.tif", polar)), lon, lat), ground(lon, lat), 0.05);
        }
    EXPECT_EQ(height_at(config_of(made("polar.tif", polar)), 0, 45), 0);  // beside the map
}

// A PDS3 label with its values attached, as LOLA's maps have them: whole numbers with a scale and an offset.
TEST(GroundMapFile, APds3LabelIsRead) {
    const std::filesystem::path file = file_named("ldem.img");
    std::string label =
        "PDS_VERSION_ID = PDS3\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = 128\r\nFILE_RECORDS = 40\r\n"
        "LABEL_RECORDS = 8\r\n^IMAGE = 9\r\nOBJECT = IMAGE\r\n LINES = 32\r\n LINE_SAMPLES = 64\r\n"
        " SAMPLE_TYPE = LSB_INTEGER\r\n SAMPLE_BITS = 16\r\n SCALING_FACTOR = 0.5\r\n OFFSET = 1737400\r\n"
        "END_OBJECT = IMAGE\r\nOBJECT = IMAGE_MAP_PROJECTION\r\n MAP_PROJECTION_TYPE = \"SIMPLE "
        "CYLINDRICAL\"\r\n"
        " A_AXIS_RADIUS = 1737.4 <KM>\r\n B_AXIS_RADIUS = 1737.4 <KM>\r\n C_AXIS_RADIUS = 1737.4 <KM>\r\n"
        " POSITIVE_LONGITUDE_DIRECTION = EAST\r\n CENTER_LATITUDE = 0 <DEG>\r\n CENTER_LONGITUDE = 180 "
        "<DEG>\r\n"
        " LINE_PROJECTION_OFFSET = 15.5 <PIX>\r\n SAMPLE_PROJECTION_OFFSET = 31.5 <PIX>\r\n"
        " MAP_RESOLUTION = 0.17777777778 <PIX/DEG>\r\n MAP_SCALE = 170.571 <KM/PIX>\r\n"
        "END_OBJECT = IMAGE_MAP_PROJECTION\r\nEND\r\n";
    label.resize(1024, ' ');
    std::ofstream out(file, std::ios::binary);
    out << label;
    for (int r = 0; r < 32; ++r)
        for (int c = 0; c < 64; ++c) {
            const int value = 20 * r - 3 * c;
            out.put(static_cast<char>(value & 0xFF)).put(static_cast<char>(value >> 8 & 0xFF));
        }
    out.close();
    GroundMapConfig config = config_of(file);
    config.offset = -kMoonRadius_m;  // the label's offset makes radii
    // Column 32 is just east of 180 E, row 16 just south of the equator.
    EXPECT_NEAR(height_at(config, 180 + 0.5 * kColumn_deg, -0.5 * kRow_deg), 0.5 * (20 * 16 - 3 * 32), 1.0);
    EXPECT_NEAR(height_at(config, 180 + 10.5 * kColumn_deg, -3.5 * kRow_deg), 0.5 * (20 * 19 - 3 * 42), 1.0);
}

TEST(GroundMapFile, ScalesOffsetsAndHolesAreAsTheFileAndTheScenarioSay) {
    MadeMap map = whole_moon();
    map.scale = 0.5, map.offset = 10;
    map.none = -32768;
    map.value = [](int c, int r) { return c == 40 && r == 20 ? -32768.0 : 200.0; };
    GroundMapConfig config = config_of(made("holes.tif", map));
    config.scale = 2, config.offset = 1;
    EXPECT_THAT(refusal_of(config),
                AllOf(HasSubstr("holes.tif"), HasSubstr("column 40, row 20"), HasSubstr("holes: fill")));
    config.holes = MapHoles::kFill;
    EXPECT_NEAR(height_at(config, 0, 0), 2 * (0.5 * 200 + 10) + 1, 1e-4);
    EXPECT_EQ(height_at(config, -180 + 40.5 * kColumn_deg, 90 - 20.5 * kRow_deg), 0);
}

// A sphere under a flattened body has planetocentric latitudes, an ellipsoid the normal's own, and the Earth's maps have geodetic ones on spheres, too.
TEST(GroundMapFile, TheFigureOfAProjectionTellsTheKindOfItsLatitudes) {
    const MappedBody mars{"mars", {3396.19e3, 3376.20e3}}, earth{"earth", {6378137, 6356752.3142}};
    MadeMap map;
    map.to_ground = {0, 0.05, 0, 45, 0, -0.05};
    map.columns = map.rows = 100;
    map.value = [](int, int r) { return r < 50 ? 1000 : 0; };
    const auto step_is_at = [&](const std::string& projection, const MappedBody& body, double latitude_deg) {
        map.projection = projection;
        std::vector<GroundMap> maps;
        maps.push_back(open_ground_map(config_of(made("figure.tif", map)), body));
        GroundSurface surface(body.figure, std::move(maps), std::size_t{1} << 20);
        const std::vector<Vec3d> places = {place_on_sphere(2.5, latitude_deg - 0.01),
                                           place_on_sphere(2.5, latitude_deg + 0.01)};
        std::vector<double> heights_m(2);
        surface.find_heights(places, 0, heights_m);
        return heights_m[0] < 500 && heights_m[1] > 500;
    };
    EXPECT_TRUE(step_is_at("+proj=longlat +R=3396190 +no_defs", mars, 42.837));
    EXPECT_TRUE(step_is_at("+proj=longlat +a=3396190 +b=3376200 +no_defs", mars, 42.5));
    EXPECT_TRUE(step_is_at("+proj=longlat +R=6371007.181 +no_defs", earth, 42.5));
    EXPECT_TRUE(step_is_at("+proj=longlat +datum=WGS84 +no_defs", earth, 42.5));
    // Mars' polar radius is its own, too.
    EXPECT_TRUE(step_is_at("+proj=longlat +R=3376200 +no_defs", mars, 42.837));
}

TEST(GroundMapFile, WhatLiesElsewhereIsNamed) {
    MadeMap map = whole_moon();
    map.projection = "";
    const GroundMapConfig bare = config_of(made("bare.tif", map));
    EXPECT_THAT(refusal_of(bare),
                AllOf(HasSubstr("bare.tif"), HasSubstr("no projection"), HasSubstr("bounds_deg")));
    GroundMapConfig placed = bare;
    placed.bounds_deg = {-180, -90, 180, 90};
    EXPECT_NEAR(height_at(placed, -180 + 10.5 * kColumn_deg, 90 - 5.5 * kRow_deg), map.value(10, 5), 1e-4);
    map.projection = "+proj=longlat +datum=WGS84 +no_defs";
    EXPECT_THAT(refusal_of(config_of(made("earth.tif", map))),
                AllOf(HasSubstr("6378.137 km"), HasSubstr("moon"), HasSubstr("1737.4 km")));
    std::ofstream(file_named("words.tif")) << "no map at all, but words";
    EXPECT_THAT(refusal_of(config_of(file_named("words.tif"))), HasSubstr("GeoTIFF"));
    EXPECT_THAT(refusal_of(config_of(file_named("absent.tif"))), HasSubstr("absent.tif"));
    EXPECT_THAT(refusal_of(config_of("/vsicurl/http://127.0.0.1:9/map.tif")), HasSubstr("/vsicurl/"));
    EXPECT_THAT(refusal_of(config_of(file_named("picture.png"))), HasSubstr("bounds_deg"));
}

// GDAL's message ends with the reason of an errno that nobody has set.
TEST(GroundMapFile, ALabelThatNamesNothingDoesNotCallThatASuccess) {
    std::ofstream(file_named("nothing.lbl"))
        << "PDS_VERSION_ID = PDS3\nRECORD_TYPE = FIXED_LENGTH\nRECORD_BYTES = 8\nFILE_RECORDS = 4\n"
           "^IMAGE = \"absent.img\"\nOBJECT = IMAGE\n LINES = 4\n LINE_SAMPLES = 4\n"
           " SAMPLE_TYPE = MSB_INTEGER\n SAMPLE_BITS = 16\nEND_OBJECT = IMAGE\nEND\n";
    std::ofstream(file_named("nothing.cub"))
        << "Object = IsisCube\n  Object = Core\n    StartByte = 1\n    Format = BandSequential\n"
           "    ^Core = absent.bin\n    Group = Dimensions\n      Samples = 4\n      Lines = 4\n      Bands "
           "= 1\n"
           "    End_Group\n    Group = Pixels\n      Type = SignedWord\n      ByteOrder = Lsb\n      Base = "
           "0.0\n"
           "      Multiplier = 1.0\n    End_Group\n  End_Object\nEnd_Object\nEnd\n";
    for (const char* name : {"nothing.lbl", "nothing.cub"}) {
        GroundMapConfig config = config_of(file_named(name));
        config.bounds_deg = {-180, -90, 180, 90};
        errno = 0;
        const std::string said = refusal_of(config);
        EXPECT_THAT(said, AllOf(HasSubstr(name), HasSubstr("accepted: "), Not(HasSubstr("Success"))));
    }
}

// A map of 20 GB, all holes of a sparse file but for what was written, is looked at from afar and from near within the
// memory that it is given.
TEST(GroundMapFile, AMapLargerThanMemoryIsReadWhereItIsLookedAt) {
    const std::filesystem::path file = file_named("large.img");
    constexpr int kColumns = 144'000, kRows = 72'000;
    std::ofstream(file).put('\0');
    std::filesystem::resize_file(file, std::uintmax_t{2} * kColumns * kRows);
    std::ofstream(file_named("large.hdr")) << "ENVI\nsamples = 144000\nlines = 72000\nbands = 1\nheader "
                                              "offset = 0\ndata type = 2\ninterleave = bsq\n"
                                              "byte order = 0\n";
    GroundMapConfig config = config_of(file);
    config.bounds_deg = {-180, -90, 180, 90};
    config.offset = 5;
    std::vector<GroundMap> maps;
    maps.push_back(open_ground_map(config, kMoonBody));
    GroundSurface surface(kMoonBody.figure, std::move(maps), std::size_t{4} << 20);
    std::vector<double> heights_m(1000);
    for (const double footprint_m : {1e5, 1e4, 100.0}) {
        std::vector<Vec3d> places;
        for (int i = 0; i < 1000; ++i) places.push_back(place_on_sphere(0.36 * i - 180, 0.17 * i - 85));
        surface.find_heights(places, footprint_m, heights_m);
        for (const double height_m : heights_m) ASSERT_NEAR(height_m, 5, 1e-9);
        EXPECT_LE(surface.pages().bytes(), std::size_t{4} << 20);
    }
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace hilcam
