// Layers of the Earth: rasters that GDAL writes, put onto a map and read by tiles.

#include "io/maps/earth_layers.h"

#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>

#include "render/earth/detail_tiles.h"
#include "render/earth/land_colors.h"
#include "render/vocabulary/check.h"

namespace hilcam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Kind = EarthLayerConfig::Kind;
using Coding = EarthLayerConfig::Coding;

struct MadeLayer {
    int columns = 512, rows = 256, bands = 1;
    std::string projection = "+proj=longlat +datum=WGS84";
    double west_deg = -180, north_deg = 90, turn_deg = 360;
    std::function<int(int, int, int)> value = [](int, int, int) { return 100; };  // band, column, row
    int none = -1;
    std::vector<std::string> options{};
};
std::filesystem::path layer_file(const std::string& name, const MadeLayer& m) {
    GDALRegister_GTiff();
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("hilcam_layers_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const std::filesystem::path file = folder / name;
    CPLStringList options;
    for (const std::string& option : m.options) options.AddString(option.c_str());
    GDALDataset* const out = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        file.c_str(), m.columns, m.rows, m.bands, GDT_Byte, options.List());
    if (!m.projection.empty()) {
        OGRSpatialReference reference;
        EXPECT_EQ(reference.importFromProj4(m.projection.c_str()), OGRERR_NONE);
        out->SetSpatialRef(&reference);
        const double step = m.turn_deg / m.columns;
        std::array<double, 6> to_ground{m.west_deg, step, 0, m.north_deg, 0, -step};
        out->SetGeoTransform(to_ground.data());
    }
    std::vector<std::uint8_t> row(static_cast<std::size_t>(m.columns));
    for (int b = 0; b < m.bands; ++b) {
        GDALRasterBand* const band = out->GetRasterBand(b + 1);
        if (m.none >= 0) band->SetNoDataValue(m.none);
        for (int r = 0; r < m.rows; ++r) {
            for (int c = 0; c < m.columns; ++c)
                row[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(m.value(b, c, r));
            EXPECT_EQ(band->RasterIO(GF_Write, 0, r, m.columns, 1, row.data(), m.columns, 1, GDT_Byte, 0, 0),
                      CE_None);
        }
    }
    GDALClose(out);
    return file;
}

// Grey land without sea and clouds.
EarthMap grey_map(int height = 64) {
    EarthMap::Level level{2 * height, height, {}};
    level.texels.assign(static_cast<std::size_t>(2 * height * height), EarthMap::Texel{128, 128, 128, 128});
    return EarthMap(EarthMap::halves(std::move(level)));
}

EarthLayerConfig layer(const std::filesystem::path& file, Kind kind, double scale = 1.0 / 255) {
    EarthLayerConfig config;
    config.file = file, config.kind = kind, config.scale = scale;
    return config;
}

std::string refusal(const EarthLayerConfig& config) {
    try {
        with_layers(grey_map(), {config});
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

// A tile's texel by its place in the level.
EarthSample texel_at(EarthDetail& detail, const EarthMap& below, int level, int column, int row) {
    std::vector<EarthMap::Texel> texels(EarthDetail::kTexels);
    const DetailKey key{level, column / EarthDetail::kTile, row / EarthDetail::kTile};
    EXPECT_TRUE(detail.read(key, below, texels));
    const EarthMap::Texel& code = texels[static_cast<std::size_t>(
        row % EarthDetail::kTile * EarthDetail::kSide + column % EarthDetail::kTile)];
    EarthSample out;
    EarthMap::mix_texels({&code, &code, &code, &code}, 0, 0, 1, out);
    return out;
}

TEST(EarthLayers, TheFinestLevelHasTheFilesOwnPosts) {
    const auto value = [](int, int c, int r) { return (7 * c + 13 * r) % 256; };
    const LayeredEarth earth =
        with_layers(grey_map(), {layer(layer_file("water.tif", {.value = value}), Kind::kWater)});
    ASSERT_TRUE(earth.detail);
    EXPECT_EQ(earth.detail->shape().levels, 2);
    for (const auto& [c, r] : {std::pair{0, 0}, {511, 255}, {130, 127}, {127, 128}, {400, 3}})
        EXPECT_NEAR(texel_at(*earth.detail, earth.map, 0, c, r).water(), value(0, c, r) / 255.0, 1e-3)
            << c << " " << r;
    // A tile's last column is the next one's first; the map's is its first again.
    std::vector<EarthMap::Texel> tile(EarthDetail::kTexels);
    earth.detail->read({0, 3, 0}, earth.map, tile);
    EXPECT_EQ(tile[EarthDetail::kTile][EarthSample::kWater], value(0, 0, 0));
    // Land is the map's own, but for open water.
    EXPECT_NEAR(texel_at(*earth.detail, earth.map, 0, 10, 10).land(0), 128 * 128 / 65025.0, 1e-4);
}

TEST(EarthLayers, CoarserLevelsAndTheMapAreMeans) {
    const auto value = [](int, int c, int) { return c / 2 % 2 ? 240 : 80; };
    const LayeredEarth earth =
        with_layers(grey_map(), {layer(layer_file("stripes.tif", {.value = value}), Kind::kWater)});
    EXPECT_NEAR(texel_at(*earth.detail, earth.map, 0, 1, 9).water(), 80 / 255.0, 1e-3);
    EXPECT_NEAR(texel_at(*earth.detail, earth.map, 1, 1, 9).water(), 240 / 255.0, 1e-3);
    EXPECT_NEAR(earth.map.sample(0.3f, 0.4f, 0.0f).water(), 160 / 255.0, 2e-3);
}

TEST(EarthLayers, AMapMayBeginAnywhere) {
    const auto value = [](int, int c, int) { return c < 256 ? 0 : 255; };
    // From the Greenwich meridian on: its first half is the east.
    const LayeredEarth earth = with_layers(
        grey_map(), {layer(layer_file("east.tif", {.west_deg = 0, .value = value}), Kind::kWater)});
    EXPECT_NEAR(texel_at(*earth.detail, earth.map, 0, 10, 10).water(), 1, 1e-3);
    EXPECT_NEAR(texel_at(*earth.detail, earth.map, 0, 500, 10).water(), 0, 1e-3);
    EXPECT_NEAR(texel_at(*earth.detail, earth.map, 0, 255, 200).water(), 1, 1e-3);
    EXPECT_NEAR(texel_at(*earth.detail, earth.map, 0, 256, 200).water(), 0, 1e-3);
}

TEST(EarthLayers, HolesShowTheMapBelow) {
    const auto value = [](int, int c, int) { return c < 256 ? 255 : 200; };
    const LayeredEarth earth = with_layers(
        grey_map(), {layer(layer_file("holes.tif", {.value = value, .none = 255}), Kind::kWater)});
    EXPECT_EQ(texel_at(*earth.detail, earth.map, 0, 10, 10).water(), 0);
    EXPECT_NEAR(texel_at(*earth.detail, earth.map, 0, 400, 10).water(), 200 / 255.0, 1e-3);
}

TEST(EarthLayers, KindsMeanWhatTheySay) {
    const auto colors = [](int band, int, int) {
        return std::array{150, 100, 50}[static_cast<std::size_t>(band)];
    };
    EarthLayerConfig land = layer(layer_file("land.tif", {.bands = 3, .value = colors}), Kind::kLand);
    const auto sample = [](const std::vector<EarthLayerConfig>& layers) {
        return with_layers(grey_map(), layers).map.sample(0.4f, 0.4f, 0.0f);
    };
    EarthSample seen = sample({land});
    EXPECT_NEAR(seen.land(0), 50 / 255.0, 3e-3);
    EXPECT_NEAR(seen.land(1), 100 / 255.0, 3e-3);
    EXPECT_NEAR(seen.land(2), 150 / 255.0, 3e-3);
    const auto even = [](int value) { return MadeLayer{.value = [value](int, int, int) { return value; }}; };
    seen = sample({land, layer(layer_file("infrared.tif", even(204)), Kind::kInfrared),
                   layer(layer_file("thickness.tif", even(100)), Kind::kCloudThickness, 0.1),
                   layer(layer_file("tops.tif", even(80)), Kind::kCloudTops, 100),
                   layer(layer_file("lights.tif", even(51)), Kind::kLights)});
    EXPECT_NEAR(seen.land(3), 0.8, 4e-3);
    // b t / (1 + b t) with t = 10.
    EXPECT_NEAR(seen.cloud(), 0.75 / 1.75, 2e-3);
    EXPECT_NEAR(seen.cloud_top_m(), 8000, 40);
    EXPECT_NEAR(seen.lights(), 0.2, 3e-3);
    // Open water has no land's colour.
    EXPECT_EQ(sample({land, layer(layer_file("sea.tif", even(255)), Kind::kWater)}).land(2), 0);
    EXPECT_NEAR(sample({layer(layer_file("clouds.tif", even(128)), Kind::kClouds)}).cloud(),
                std::pow(128 / 255.0, 1.33), 3e-3);
    land.coding = Coding::kSrgb, land.scale = 1;
    EXPECT_NEAR(sample({land}).land(0), 0.0319, 2e-3);  // sRGB's code 50
    // Red sand of the Blue Marble is that of Libya-4.
    const auto sand = [](int band, int, int) {
        return std::array{205, 178, 136}[static_cast<std::size_t>(band)];
    };
    EarthLayerConfig marble = layer(layer_file("marble.tif", {.bands = 3, .value = sand}), Kind::kLand, 1);
    marble.coding = Coding::kBlueMarble;
    seen = sample({marble});
    EXPECT_NEAR(seen.land(0), 0.25, 0.01);
    EXPECT_NEAR(seen.land(2), 0.46, 0.01);
    EXPECT_NEAR(seen.land(3), 0.58, 0.01);
}

TEST(EarthLayers, WhatCannotBeUsedIsNamed) {
    const auto kind = Kind::kWater;
    EXPECT_THAT(refusal(layer("missing.tif", kind)), HasSubstr("missing.tif"));
    EXPECT_THAT(refusal(layer(layer_file("bare.tif", {.projection = ""}), kind)),
                HasSubstr("has no projection"));
    EXPECT_THAT(refusal(layer(layer_file("moon.tif", {.projection = "+proj=longlat +R=1737400"}), kind)),
                HasSubstr("is of a body of radius 1737.4 km"));
    EXPECT_THAT(
        refusal(layer(layer_file("polar.tif", {.projection = "+proj=stere +lat_0=90 +datum=WGS84"}), kind)),
        HasSubstr("does not cover the whole Earth in longitude and latitude"));
    EXPECT_THAT(refusal(layer(layer_file("part.tif", {.turn_deg = 300}), kind)),
                HasSubstr("does not cover the whole Earth"));
    EXPECT_THAT(refusal(layer(layer_file("flat.tif", {.columns = 512, .rows = 200}), kind)),
                HasSubstr("does not cover the whole Earth"));
    EXPECT_THAT(refusal(layer(layer_file("rgb.tif", {.bands = 3}), kind)),
                HasSubstr("has 3 channels; accepted: one"));
    EXPECT_THAT(refusal(layer(layer_file("grey.tif", {.bands = 1}), Kind::kLand)),
                HasSubstr("has 1 channel; accepted: red, green and blue"));
    EarthLayerConfig bounded =
        layer(layer_file("odd.tif", {.columns = 500, .rows = 256, .projection = ""}), kind);
    bounded.bounds_deg = {-180, -90, 180, 90};
    EXPECT_THAT(refusal(bounded), HasSubstr("has 500 x 256 posts; accepted: twice as many columns as rows"));
    EarthLayerConfig placed = layer("missing.tif", kind);
    placed.where = "bench.yaml:7:11: earth_surface.layers.0.file";
    EXPECT_THAT(refusal(placed), HasSubstr("missing.tif"));
    const std::string large = refusal(layer(
        layer_file("large.tif", {.columns = 16640, .rows = 8320, .options = {"SPARSE_OK=TRUE", "TILED=YES"}}),
        kind));
    EXPECT_THAT(large, AllOf(HasSubstr("16640 x 8320 posts and no overviews"), HasSubstr("gdaladdo")));
}

// A block of the file whose bytes are gone: what is as coarse as the map is refused at the start, else it is told of the tile.
TEST(EarthLayers, DamageIsToldWhereItIsMet) {
    const std::filesystem::path file = layer_file(
        "damaged.tif", {.columns = 4096,
                        .rows = 2048,
                        .value = [](int, int c, int r) { return (c * r) % 251; },
                        .options = {"TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=256", "COMPRESS=DEFLATE"}});
    {
        GDALRegister_GTiff();
        GDALDataset* const open = GDALDataset::FromHandle(GDALOpen(file.c_str(), GA_Update));
        int factors[] = {2, 4, 8, 16, 32};
        ASSERT_EQ(open->BuildOverviews("AVERAGE", 5, factors, 0, nullptr, nullptr, nullptr), CE_None);
        GDALClose(open);
    }
    // The first blocks written are those of the finest level, in the north-west.
    {
        std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
        bytes.seekp(2000);
        for (int i = 0; i < 3000; ++i) bytes.put('\x55');
    }
    const LayeredEarth earth = with_layers(grey_map(), {layer(file, Kind::kWater)});
    ASSERT_TRUE(earth.detail);
    std::vector<EarthMap::Texel> texels(EarthDetail::kTexels);
    EXPECT_FALSE(earth.detail->read({0, 0, 0}, earth.map, texels));
    EXPECT_TRUE(earth.detail->read({0, 20, 8}, earth.map, texels));
    EXPECT_TRUE(earth.detail->read({2, 0, 0}, earth.map, texels));
}

}  // namespace
}  // namespace hilcam
